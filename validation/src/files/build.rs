//! Identifies this build of the program. Values that were unknown at build time are "unknown".

use serde::Serialize;

/// A build of the program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Build {
    /// Name of the program.
    pub program: &'static str,
    /// Version of the package.
    pub version: &'static str,
    /// Commit of the sources, with `-dirty` if they had been changed.
    pub commit: &'static str,
    /// Version of the compiler.
    pub rustc: &'static str,
    /// The profile of cargo: `release`, or `debug` as by `cargo run`, in which what computes is optimised.
    pub build: &'static str,
}

/// This build.
pub const BUILD: Build = Build {
    program: "shearbed",
    version: env!("CARGO_PKG_VERSION"),
    commit: env!("SHEARBED_COMMIT"),
    rustc: env!("SHEARBED_RUSTC"),
    build: env!("SHEARBED_PROFILE"),
};

/// The year of this version, for citations.
pub const YEAR: u32 = 2026;

/// A digest of the sources of this build, of the compiler and of its settings.
pub const SOURCES: &str = env!("SHEARBED_SOURCES");

/// A record with the build that wrote it.
#[derive(Serialize)]
struct Made<'a, T> {
    #[serde(flatten)]
    build: Build,
    #[serde(flatten)]
    data: &'a T,
}

/// A structure as JSON, preceded by the build that wrote it.
pub fn json(data: &impl Serialize) -> Result<String, String> {
    let made = Made { build: BUILD, data };
    super::text::json(&made).map_err(|error| error.to_string())
}
