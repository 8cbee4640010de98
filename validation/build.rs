//! Keeps the compiler's version, and the commit and a digest of the sources, as they are when the program is built.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::process::Command;

/// What the program is made of, from the workspace's root.
const SOURCES: [&str; 17] = [
    "Cargo.toml",
    "Cargo.lock",
    "src",
    "validation/Cargo.toml",
    "validation/build.rs",
    "validation/cli/Cargo.toml",
    "validation/cli/src",
    "validation/methods/Cargo.toml",
    "validation/methods/src",
    "validation/oracle/Cargo.toml",
    "validation/oracle/src",
    "validation/fonts",
    "validation/peers",
    "validation/published",
    "validation/schemas",
    "validation/src",
    "validation/scenes",
];

fn main() {
    let here = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default();
    let root = Path::new(&here).join("..");
    for source in SOURCES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
    }
    println!("cargo::rerun-if-env-changed=RUSTC");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let rustc = printed(Command::new(rustc).arg("--version"));
    let digest = digest(&root, rustc.as_deref());
    println!("cargo::rustc-env=SHEARBED_SOURCES={digest}");
    println!("cargo::rustc-env=SHEARBED_RUSTC={}", known(rustc));
    println!("cargo::rustc-env=SHEARBED_COMMIT={}", known(commit(&root)));
    println!("cargo::rustc-env=SHEARBED_PROFILE={}", known(std::env::var("PROFILE").ok()));
}

/// A digest of everything that decides the program's numbers: the sources, the compiler and its settings.
fn digest(root: &Path, rustc: Option<&str>) -> String {
    let mut hasher = DefaultHasher::new();
    SOURCES.iter().for_each(|source| add(&root.join(source), &mut hasher));
    rustc.hash(&mut hasher);
    for name in ["PROFILE", "OPT_LEVEL", "TARGET", "CARGO_ENCODED_RUSTFLAGS"] {
        std::env::var(name).ok().hash(&mut hasher);
    }
    format!("{:016x}", hasher.finish())
}

/// Adds a file, or a folder's files in the order of their names.
fn add(path: &Path, hasher: &mut DefaultHasher) {
    let Ok(entries) = path.read_dir() else { return (path.file_name(), std::fs::read(path).ok()).hash(hasher) };
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths.iter().for_each(|path| add(path, hasher));
}

/// The commit of the sources, with `-dirty` where one of them is not as it is there; nothing outside a checkout of this
/// project, as in a package or in somebody else's repository.
fn commit(root: &Path) -> Option<String> {
    let git = |arguments: &[&str]| {
        let mut git = Command::new("git");
        // A hook of git runs with these set.
        for name in ["GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE"] {
            git.env_remove(name);
        }
        printed(git.arg("-C").arg(root).args(arguments))
    };
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if Path::new(&top).canonicalize().ok()? != root.canonicalize().ok()? {
        return None;
    }
    git(&["ls-files", "--error-unmatch", "validation/build.rs"])?;
    // Changes with every commit and checkout; where it is not kept, HEAD and what it points to do.
    for name in ["logs/HEAD", "HEAD"] {
        let path = root.join(git(&["rev-parse", "--git-path", name])?);
        if path.exists() {
            println!("cargo::rerun-if-changed={}", path.display());
        }
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let mut status = vec!["status", "--porcelain", "--untracked-files=all", "--"];
    status.extend(SOURCES);
    if git(&status)?.is_empty() { Some(commit) } else { Some(format!("{commit}-dirty")) }
}

/// What a command prints, if it is there and succeeds.
fn printed(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

fn known(text: Option<String>) -> String {
    text.filter(|text| !text.is_empty()).unwrap_or_else(|| "unknown".to_owned())
}
