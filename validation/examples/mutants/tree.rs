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
    /// The folder of the package that has the mutants, below the root.
    package: String,
    /// Where it is built: cargo takes the copy's crates for those that it was copied from, if it finds these.
    target: PathBuf,
    /// The place of each mutant that can be switched on.
    pub places: BTreeMap<usize, usize>,
    /// The mutants that do not compile.
    pub refused: BTreeSet<usize>,
}

impl Tree {
    /// Copies what is under version control to `out/tree`, which is built in `out/target`, and puts the mutants of one package in.
    pub fn new(from: &Path, out: &Path, mutants: &[Mutant]) -> Result<Tree, Box<dyn Error>> {
        let file = &mutants[0].file;
        let mut tree = Tree {
            root: out.join("tree"),
            package: file[..file.rfind("src/").ok_or("a mutant beside src")?].to_owned(),
            target: out.join("target"),
            places: BTreeMap::new(),
            refused: BTreeSet::new(),
        };
        if tree.root.exists() {
            fs::remove_dir_all(&tree.root)?;
        }
        let listed = Command::new("git")
            .arg("-C")
            .arg(from)
            .args(["ls-files", "-z"])
            .output()?;
        for file in String::from_utf8(listed.stdout)?.split_terminator('\0') {
            let to = tree.root.join(file);
            fs::create_dir_all(to.parent().ok_or("a file in no folder")?)?;
            fs::copy(from.join(file), to)?;
        }
        // Some complaints are of code generation only.
        for command in ["check", "build"] {
            loop {
                tree.write(from, mutants)?;
                let complaints = tree.complaints(command, &mutants[0].package)?;
                if complaints.is_empty() {
                    break;
                }
                if complaints.is_subset(&tree.refused) {
                    return Err("the compiler complains of mutants that are no longer there".into());
                }
                tree.refused.extend(complaints);
            }
        }
        Ok(tree)
    }

    fn write(&mut self, from: &Path, mutants: &[Mutant]) -> Result<(), Box<dyn Error>> {
        // The library has the switches.
        let library = format!("{}src/lib.rs", self.package);
        let mut of: BTreeMap<&str, Vec<&Mutant>> = BTreeMap::from([(library.as_str(), Vec::new())]);
        for mutant in mutants {
            // A file of which all are refused is written without them.
            let of_file = of.entry(&mutant.file).or_default();
            if !self.refused.contains(&mutant.id) {
                of_file.push(mutant);
            }
        }
        self.places.clear();
        for (file, of_file) in &of {
            let (mut text, places) = switches::switch(&fs::read_to_string(from.join(file))?, of_file)?;
            self.places.extend(places);
            if *file == library {
                text += &switches::module(mutants.len() + 1);
            }
            fs::write(self.root.join(file), text)?;
        }
        Ok(())
    }

    /// The mutants that the compiler refuses: each complaint lies in the text of one.
    fn complaints(&self, command: &str, package: &str) -> Result<BTreeSet<usize>, Box<dyn Error>> {
        let (messages, failed) = self.cargo(&[command, "--lib", "--package", package])?;
        let mut refused = BTreeSet::new();
        for message in &messages {
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
        match failed {
            Some(why) if refused.is_empty() => Err(why.into()),
            _ => Ok(refused),
        }
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

    /// Whether a folder is the package's.
    pub fn is_package(&self, folder: &Path) -> bool {
        folder == self.root.join(&self.package)
    }

    /// What a cargo command says in JSON, and why it failed where it did.
    pub fn cargo(&self, arguments: &[&str]) -> Result<(Vec<Value>, Option<String>), Box<dyn Error>> {
        let out = Command::new("cargo")
            .current_dir(&self.root)
            .env("CARGO_TARGET_DIR", &self.target)
            .args(arguments)
            .args(["--locked", "--message-format=json"])
            .output()?;
        let text = String::from_utf8(out.stdout)?;
        let messages = text.lines().flat_map(serde_json::from_str).collect();
        let failed = (!out.status.success()).then(|| String::from_utf8_lossy(&out.stderr).into_owned());
        Ok((messages, failed))
    }
}
