//! Which build of the program this is. What was not known when it was built is "unknown".

use serde::Serialize;
use serde_json::{Value, json};

/// A build of the program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Build {
    /// The program's name.
    pub program: &'static str,
    /// The version of the package.
    pub version: &'static str,
    /// The commit of the sources it was built from, with `-dirty` where they had been changed since.
    pub commit: &'static str,
    /// The compiler.
    pub rustc: &'static str,
    /// `release`, or `development` with debug assertions.
    pub build: &'static str,
}

/// This build.
pub const BUILD: Build = Build {
    program: "shearbed",
    version: env!("CARGO_PKG_VERSION"),
    commit: env!("SHEARBED_COMMIT"),
    rustc: env!("SHEARBED_RUSTC"),
    build: if cfg!(debug_assertions) { "development" } else { "release" },
};

/// This build as an object, to which the rest of a record is added.
pub fn record() -> Value {
    json!(BUILD)
}

/// A record with the build that made it.
#[derive(Serialize)]
struct Made<'a, T> {
    #[serde(flatten)]
    build: Build,
    #[serde(flatten)]
    data: &'a T,
}

/// Any structure as JSON, after the build that made it.
pub fn json(data: &impl Serialize) -> Result<String, String> {
    let made = Made { build: BUILD, data };
    let text = serde_json::to_string_pretty(&made).map_err(|error| error.to_string())?;
    Ok(text + "\n")
}
