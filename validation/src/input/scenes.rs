//! The built-in scenes: the paper's figures, one file each in `validation/scenes/`, declared only here.

use shearbed::Scene;
use shearbed::{Error, scene};

/// A scene that is part of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltIn {
    /// Name on the command line: the stem of the file's name.
    pub name: &'static str,
    /// Text of the file.
    pub text: &'static str,
}

impl BuiltIn {
    /// Reads and checks the scene.
    pub fn scene(&self) -> Result<Scene, Error> {
        scene::parse(&format!("{}.toml", self.name), self.text)
    }
}

macro_rules! built_in {
    ($($name:literal)*) => {
        /// Every built-in scene, in the order of the paper's figures.
        pub const ALL: &[BuiltIn] = &[$(BuiltIn {
            name: $name,
            text: include_str!(concat!("../../scenes/", $name, ".toml")),
        }),*];
    };
}

built_in! {
    "fig4-n20" "fig4-n50" "fig4-n100"
    "fig5"
    "fig6-uniform" "fig6-polydisperse" "fig6-interacting"
    "fig7-n20" "fig7-n50" "fig7-n100"
    "fig8-a0.36" "fig8-a0.72" "fig8-a1.44"
    "fig9-sd0" "fig9-sd1.8" "fig9-sd3.6" "fig9-sd7.2"
    "fig10-free-sd0" "fig10-free-sd3.6" "fig10-interacting-sd0" "fig10-interacting-sd3.6"
    "fig11-re5" "fig11-re10" "fig11-re11.6" "fig11-re14.2" "fig11-re20" "fig11-re30" "fig11-re50"
    "fig12"
    "extension"
}

/// The built-in scene called `name`, or `None`.
pub fn find(name: &str) -> Option<&'static BuiltIn> {
    ALL.iter().find(|scene| scene.name == name)
}

/// The checked built-in scene called `name`, or `None`.
pub fn scene(name: &str) -> Option<Scene> {
    find(name)?.scene().ok()
}

/// Up to three of these names of which `word` may be a misspelling, the closest first.
pub fn near<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let likeness = |name: &&str| shearbed::scene::likeness(word, name);
    let mut close: Vec<_> = names.filter(|name| likeness(name) > 0.85).collect();
    close.sort_by(|a, b| likeness(b).total_cmp(&likeness(a)));
    close.truncate(3);
    close
}

#[cfg(test)]
mod tests {
    use super::*;
    use shearbed::Plan;

    #[test]
    fn every_scene_is_planned_and_runs() {
        for built_in in ALL {
            let mut scene = built_in.scene().unwrap();
            scene.ensemble.replicas = 2;
            scene.particles.count = scene.particles.count.min(100);
            let results = shearbed::run::ensemble::run(&Plan::new(&scene).unwrap()).unwrap();
            let means = results.series.iter().flat_map(|s| &s.columns).flat_map(|c| &c.mean);
            assert!(means.into_iter().all(|mean| mean.is_finite()), "{}", built_in.name);
        }
    }
}
