//! `shearbed cite`: how to cite this build.

use super::{Failure, print};
use shearbed_validation::files::build::{BUILD, YEAR};

/// Prints BibTeX with the version, the commit and the features of this build.
pub(super) fn cite() -> Result<(), Failure> {
    let features = if cfg!(feature = "mpi") { "mpi" } else { "none" };
    print(&format!(
        "@software{{shearbed,\n  title   = {{shearbed: a verification-first testbed for rigid slender rods in a \
         sheared viscous liquid}},\n  author  = {{{{The shearbed authors}}}},\n  version = {{{}}},\n  year    = \
         {{{YEAR}}},\n  note    = {{commit {}, {}, {} build, features: {features}}},\n}}\n\n\
         @article{{lee-springer-1982,\n  author  = {{Lee, W. I. and \
         Springer, G. S.}},\n  journal = {{J. Reinforced Plastics and Composites}},\n  volume  = {{1}},\n  \
         pages   = {{279}},\n  month   = oct,\n  year    = {{1982}},\n}}\n",
        BUILD.version, BUILD.commit, BUILD.rustc, BUILD.build
    ))
}
