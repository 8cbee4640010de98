//! A copy of the workspace in which every mutant that compiles has a switch.

use crate::switches::{self, Mutant};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

pub struct Tree {
    pub root: PathBuf,
    /// The library file of the package, which has the switches.
    library: String,
    pub target: PathBuf,
    /// The place of each mutant that can be switched on.
    pub places: BTreeMap<usize, usize>,
    /// The mutants that do not compile.
    pub refused: BTreeSet<usize>,
}

impl Tree {
    /// Copies what is under version control to `root`, and puts the mutants of one package in but for those that are known not to
    /// compile.
    pub fn new(
        from: &Path,
        root: PathBuf,
        package: &str,
        mutants: &[Mutant],
        refused: BTreeSet<usize>,
    ) -> Result<Tree, Box<dyn Error>> {
        let listed = Command::new("git")
            .arg("-C")
            .arg(from)
            .args(["ls-files", "-z"])
            .output()?;
        let file = &mutants.first().ok_or("no mutants")?.file;
        let folder = &file[..file.rfind("src/").ok_or("a mutant beside src")?];
        let library = format!("{folder}src/lib.rs");
        let is_switched = |file: &str| file == library || mutants.iter().any(|mutant| mutant.file == file);
        for file in String::from_utf8(listed.stdout)?.split_terminator('\0') {
            if !is_switched(file) {
                put(&root.join(file), &fs::read(from.join(file))?)?;
            }
        }
        let mut tree = Tree {
            // One of its own: cargo takes the copy's crates for those that it was copied from.
            target: root.join("target"),
            root,
            library,
            places: BTreeMap::new(),
            refused,
        };
        // Some complaints are of code generation only.
        for command in ["check", "build"] {
            loop {
                tree.write(from, mutants)?;
                let complaints = tree.complaints(command, package)?;
                if complaints.is_empty() {
                    break;
                }
                tree.refused.extend(complaints);
            }
        }
        Ok(tree)
    }

    fn write(&mut self, from: &Path, mutants: &[Mutant]) -> Result<(), Box<dyn Error>> {
        let library = self.library.clone();
        let mut of: BTreeMap<&str, Vec<&Mutant>> = BTreeMap::from([(library.as_str(), Vec::new())]);
        for mutant in mutants.iter().filter(|mutant| !self.refused.contains(&mutant.id)) {
            of.entry(&mutant.file).or_default().push(mutant);
        }
        let mut all = BTreeMap::new();
        for (file, of_file) in &of {
            let (mut text, places) = switches::switch(&fs::read_to_string(from.join(file))?, of_file)?;
            all.extend(places);
            if *file == library {
                text += &switches::module(mutants.len() + 1);
            }
            put(&self.root.join(file), text.as_bytes())?;
        }
        self.places = all;
        Ok(())
    }

    /// The mutants that the compiler refuses: each complaint lies in the text of one.
    fn complaints(&self, command: &str, package: &str) -> Result<BTreeSet<usize>, Box<dyn Error>> {
        let out = self
            .cargo()
            .args([
                command,
                "--lib",
                "--locked",
                "--message-format=json",
                "--package",
                package,
            ])
            .output()?;
        let mut refused = BTreeSet::new();
        for message in String::from_utf8(out.stdout)?
            .lines()
            .flat_map(serde_json::from_str::<Value>)
        {
            let message = &message["message"];
            if message["level"] != "error" {
                continue;
            }
            let spans = message["spans"].as_array().map_or(&[][..], Vec::as_slice);
            let found = spans.iter().find_map(|span| self.mutant_at(span));
            match found {
                Some(id) => _ = refused.insert(id),
                None if spans.is_empty() => {}
                None => {
                    return Err(
                        format!("not of a mutant: {}", message["rendered"].as_str().unwrap_or("?")).into(),
                    );
                }
            }
        }
        if refused.is_empty() && !out.status.success() {
            return Err(String::from_utf8_lossy(&out.stderr).into_owned().into());
        }
        Ok(refused)
    }

    /// The mutant whose text a complaint is about, or the macro that it is about.
    fn mutant_at(&self, span: &Value) -> Option<usize> {
        let within = &span["expansion"]["span"];
        if !within.is_null() {
            return self.mutant_at(within);
        }
        let text = fs::read_to_string(self.root.join(span["file_name"].as_str()?)).ok()?;
        let at = usize::try_from(span["byte_start"].as_u64()?).ok()?;
        let (id, _) = text.get(..at)?.rsplit_once("/*<")?.1.split_once("*/")?;
        let end = text.find(&format!("/*{id}>*/"))?;
        (at <= end).then(|| id.parse().ok())?
    }

    pub fn cargo(&self) -> Command {
        let mut cargo = Command::new("cargo");
        cargo
            .current_dir(&self.root)
            .env("CARGO_TARGET_DIR", &self.target);
        cargo
    }
}

/// Writes a file where it is not so already: what has not changed is not built again.
fn put(path: &Path, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    if fs::read(path).ok().as_deref() != Some(bytes) {
        fs::create_dir_all(path.parent().ok_or("a file in no folder")?)?;
        fs::write(path, bytes)?;
    }
    Ok(())
}
