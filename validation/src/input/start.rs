//! Rods defined by a file beside the scene: length, r_e, direction and position of each.

mod table;

use crate::files::text::Shown;
use shearbed::plan::counted;
use shearbed::scene::{COUNTED, OwnRods, RodsFile, Scene};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use table::read;

/// The files read for scenes of one folder: each is read once, and its rods are stored once.
#[derive(Clone, Debug, Default)]
pub struct Starts {
    folder: PathBuf,
    read: BTreeMap<String, Start>,
}

#[derive(Clone, Debug)]
struct Start {
    crc32: String,
    own: Arc<OwnRods>,
    /// The line of each rod in the file.
    lines: Arc<Vec<u64>>,
    warning: Option<String>,
}

impl Starts {
    /// For scenes whose files are in `folder`; reads nothing yet.
    pub fn beside(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), read: BTreeMap::new() }
    }

    /// The checksums (CRC-32) of the files read.
    pub fn checksums(&self) -> BTreeMap<&str, &str> {
        (self.read.iter()).map(|(file, start)| (file.as_str(), start.crc32.as_str())).collect()
    }

    /// Warnings on what the files have.
    pub fn warnings(&self) -> impl Iterator<Item = &String> {
        self.read.values().filter_map(|start| start.warning.as_ref())
    }

    /// The paths of the files read.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.read.keys().map(|file| self.folder.join(file))
    }

    /// Loads the file of `particles.rods` into the scene. A scene without one is left unchanged.
    ///
    /// # Errors
    ///
    /// A message with file, line, column and value, and what is allowed.
    pub fn fill(&mut self, scene: &mut Scene) -> Result<(), String> {
        let Some(RodsFile { file, crc32, .. }) = &scene.particles.rods else {
            return Ok(());
        };
        let path = self.folder.join(file);
        let refused = |what: String| format!("particles.rods: {}{what}", path.shown());
        let start = match self.read.get(file) {
            Some(start) => start.clone(),
            None => {
                let bytes = crate::files::bounded::bytes(&path, 1 << 31)
                    .map_err(|error| refused(format!(": cannot be read: {error}")))?;
                let (own, lines, warning) = read(&path, &bytes).map_err(|error| format!("particles.rods: {error}"))?;
                let start = Start {
                    crc32: format!("{:08x}", crc32fast::hash(&bytes)),
                    own: Arc::new(own),
                    lines: Arc::new(lines),
                    warning,
                };
                self.read.insert(file.clone(), start.clone());
                start
            }
        };
        if let Some(expected) = crc32.as_deref().filter(|expected| *expected != start.crc32) {
            let found = &start.crc32;
            return Err(refused(format!(": has crc32 = {found}; {expected:?} is allowed, or no crc32")));
        }
        if scene.particles.count == COUNTED {
            scene.particles.count = start.lines.len();
        }
        fits(scene, &start).map_err(refused)?;
        if let Some(rods) = &mut scene.particles.rods {
            (rods.crc32, rods.own) = (Some(start.crc32), Some(start.own));
        }
        Ok(())
    }
}

/// Checks that the scene allows the rods of a file; an error starts with the line.
fn fits(scene: &Scene, start: &Start) -> Result<(), String> {
    let (count, rows, own) = (scene.particles.count, start.lines.len(), &start.own);
    if rows != count {
        return Err(format!(": has {}; as many as particles.count = {count} are allowed", counted(rows as u64, "row")));
    }
    match scene.misfit(own) {
        Some(misfit) => Err(format!(
            ":{}: {} = {:?} is not allowed: expected {}",
            start.lines[misfit.rod], misfit.column, misfit.value, misfit.allowed
        )),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file is removed after reading, so that a second reading would fail.
    #[test]
    fn a_file_is_read_and_held_once_for_all_scenes() {
        let text = crate::input::scenes::find("extension").unwrap().text;
        let mut first = shearbed::scene::parse("s", text).unwrap();
        first.particles.count = 1;
        first.particles.rods = Some(RodsFile { own: None, ..RodsFile::with("start.csv", OwnRods::default()) });
        let of = |scene: &Scene| scene.particles.rods.as_ref().unwrap().own.clone().unwrap();
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("start.csv");
        let mut starts = Starts::beside(dir.path());
        let (mut a, mut b) = (first.clone(), first);
        std::fs::write(&file, "p1,p2,p3\n1,0,0\n").unwrap();
        starts.fill(&mut a).unwrap();
        std::fs::remove_file(&file).unwrap();
        starts.fill(&mut b).unwrap();
        assert!(Arc::ptr_eq(&of(&a), &of(&b)));
    }
}
