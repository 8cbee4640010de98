//! The law of one length: α, a and n of interacting rods enter by α·a·n^(1/3) alone.

use super::{Range, SceneError, Scenes};
use crate::methods::least_squares::Datum;
use nalgebra::DMatrix;
use shearbed::Scene;

/// The keys of the one length of interacting rods, α·a·n^(1/3).
const LENGTHS: [&str; 4] =
    ["interaction.alpha", "interaction.concentration_per_cm3", "particles.length_mm", "particles.volume_fraction"];

/// The powers of a key of [`LENGTHS`] in what a scene depends on: α·a·n^(1/3); in a box of its own size or with places
/// in mm, α·a, and n beside it. With a volume fraction n is ∝ 1/a³. The lengths of a file have nothing to do with a.
fn powers(scene: &Scene, key: &str) -> [f64; 2] {
    let own = scene.particles.rods.as_ref().and_then(|rods| rods.own.as_deref());
    let has_lengths = own.is_some_and(|own| own.length_mm.is_some());
    let has_places = own.is_some_and(|own| own.place_mm.is_some());
    let has_box = scene.interaction.as_ref().is_some_and(|interaction| interaction.box_mm.is_some());
    let [alpha_a, n] = match key {
        "interaction.alpha" => [1.0, 0.0],
        "particles.length_mm" if has_lengths => [0.0, 0.0],
        "particles.length_mm" if scene.particles.volume_fraction.is_some() => [1.0, -3.0],
        "particles.length_mm" => [1.0, 0.0],
        _ => [0.0, 1.0],
    };
    match (has_box, has_places) {
        (true, _) => [alpha_a, 0.0],
        (_, true) => [alpha_a, n],
        _ => [alpha_a + n / 3.0, 0.0],
    }
}

impl Scenes {
    /// Refuses to fit keys that data cannot separate. Rods with contacts at any arm depend on α, a and n by α·a·n^(1/3)
    /// in the cube of their concentration, by α·a in a box (case `one-length-scale`): each scene fixes one or two
    /// combinations of the logarithms of these keys, and fewer than there are keys are too few.
    pub fn one_length(&self, data: &[Datum]) -> Result<(), SceneError> {
        let sets = 0..self.sets.len();
        let from: Vec<f64> = self.ranges.iter().map(|range| range.from).collect();
        let scenes = sets.clone().map(|set| self.scene(set, &from)).collect::<Result<Vec<_>, _>>()?;
        let lengths: Vec<&Range> = self.ranges.iter().filter(|range| LENGTHS.contains(&&range.key[..])).collect();
        let here = |set: &usize| lengths.iter().any(|range| range.is_of(*set));
        let holds = |set: usize| {
            let in_pa = data.iter().any(|datum| datum.set == set && datum.column.ends_with("_pa"));
            !in_pa && scenes[set].interaction.as_ref().is_some_and(|interaction| interaction.min_contact_arm == 0.0)
        };
        if lengths.is_empty() || !sets.clone().filter(here).all(holds) {
            return Ok(());
        }
        let power = |row: usize, range: usize| {
            let (set, range) = (row / 2, lengths[range]);
            if range.is_of(set) { powers(&scenes[set], &range.key)[row % 2] } else { 0.0 }
        };
        let known = DMatrix::from_fn(2 * scenes.len(), lengths.len(), power).rank(1e-9);
        let Some(set) = sets.clone().find(here).filter(|_| known < lengths.len()) else {
            return Ok(());
        };
        Err(SceneError::Parameters {
            scene: self.sets[set].source.clone(),
            parameters: lengths.iter().map(|range| range.label()).collect(),
            why: format!(
                "points do not tell these keys apart: contact lines are infinite, so the rods' length enters by s/(aα) \
                 alone, and α, a and n by α·a·n^(1/3) alone; fix {}",
                if lengths.len() > 1 { "one of them" } else { "it" }
            ),
        })
    }
}
