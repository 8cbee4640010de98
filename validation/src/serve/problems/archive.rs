//! All problems as one archive for a data repository: versioned, with checksums, licence and citation.
//!
//! A tar file (POSIX ustar, not compressed) with the same bytes each time: names ascend, times are 0.

use super::{FORMAT, all, built, files};
use crate::files::build::{BUILD, YEAR};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

const LICENCE: &str = include_str!("data/LICENSE-MIT");

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A block of a tar file, in bytes.
const BLOCK: usize = 512;

/// The archive's bytes: each problem's folder, `README.md`, `LICENSE`, `CITATION.cff`, and `SHA256SUMS` over all of
/// them.
pub fn archive() -> Vec<u8> {
    let mut contents = BTreeMap::from([
        ("README.md".to_owned(), readme()),
        ("LICENSE".to_owned(), LICENCE.to_owned()),
        ("CITATION.cff".to_owned(), citation()),
    ]);
    for problem in built() {
        let of = files(problem).into_iter();
        contents.extend(of.map(|(file, text)| (format!("{}/{file}", problem.problem.name), text)));
    }
    let hex = |text: &String| Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let sum = |(name, text): (&String, &String)| format!("{}  {name}\n", hex(text));
    let sums: String = contents.iter().map(sum).collect();
    contents.insert("SHA256SUMS".to_owned(), sums);
    let mut tar = Vec::new();
    for (name, text) in &contents {
        tar.extend(header(&format!("shearbed-problems-{VERSION}/{name}"), text.len()));
        tar.extend(text.as_bytes());
        tar.resize(tar.len().next_multiple_of(BLOCK), 0);
    }
    // Two empty blocks end the archive.
    tar.resize(tar.len() + 2 * BLOCK, 0);
    tar
}

/// The header of a file: fields at fixed places, numbers in octal, and a checksum.
fn header(path: &str, length: usize) -> [u8; BLOCK] {
    let mut block = [0; BLOCK];
    let mut put = |at: usize, text: &str| block[at..at + text.len()].copy_from_slice(text.as_bytes());
    assert!(path.len() < 100, "{path}: a name of a tar file has less than 100 bytes");
    put(0, path);
    put(100, "0000644");
    put(108, "0000000");
    put(116, "0000000");
    put(124, &format!("{length:011o}"));
    put(136, "00000000000");
    // The checksum counts its own field as blanks.
    put(148, "        ");
    put(156, "0");
    put(257, "ustar\x0000");
    let sum: u32 = block.iter().map(|byte| u32::from(*byte)).sum();
    block[148..155].copy_from_slice(format!("{sum:06o}\0").as_bytes());
    block
}

fn readme() -> String {
    let problems: String = all().iter().map(|def| format!("- `{}`: {}\n", def.name, def.title)).collect();
    format!(
        "# Reference problems for rigid rods in shear flow\n\n{} problems with their answers, version {VERSION}, \
         format {FORMAT}. Any program that moves rigid rods (fibres, ellipsoids) by Jeffery's equation, or after Lee & \
         Springer (1982), can be verified with them.\n\n\
         Each folder has a description to read (`README.md`) and one for programs (`problem.json`), the start \
         (`start.csv`, or pairs of rods in `inputs.csv`) and the certified answer (`certified.csv`) with more digits \
         than a double holds. `sha256sum -c SHA256SUMS` checks the files.\n\n\
         Write your answers to `mine/NAME/answer.csv` and compare them as the pages say, or with the program that made \
         the problems: `shearbed grade shearbed-problems-{VERSION} mine`.\n\n## The problems\n\n{problems}\n\
         ## Sources\n\nW. I. Lee and G. S. Springer, J. Reinforced Plastics and Composites 1, 279 (1982): the \
         equations that are cited by number. G. B. Jeffery, Proc. R. Soc. A 102, 161 (1922): the motion of an \
         ellipsoid.\n\nLicence: `LICENSE`. How to cite: `CITATION.cff`.\n",
        all().len(),
    )
}

fn citation() -> String {
    let named = format!(
        "title: \"Reference problems for rigid rods in shear flow\"\nauthors:\n  - name: \"The shearbed authors\"\n\
         version: \"{VERSION}\"\n"
    );
    format!(
        "cff-version: 1.2.0\nmessage: \"If you use these problems, please cite them as below.\"\ntype: dataset\n\
         {named}commit: \"{}\"\nlicense: MIT\nkeywords:\n  - verification\n  - Jeffery orbits\n  - fibre orientation\n\
         preferred-citation:\n  type: data\n  year: {YEAR}\n  {}\n",
        BUILD.commit,
        named.trim_end().replace('\n', "\n  "),
    )
}
