//! The law of one length: α, a and n of interacting rods enter by α·a·n^(1/3) alone.

use super::{Range, SceneError, Scenes};
use crate::methods::least_squares::Datum;
use nalgebra::DMatrix;
use shearbed::Scene;

/// The keys of the one length of interacting rods, α·a·n^(1/3).
const LENGTHS: [&str; 4] =
    ["interaction.alpha", "interaction.concentration_per_cm3", "particles.length_mm", "particles.volume_fraction"];

/// The power of a key of [`LENGTHS`] in α·a·n^(1/3); with a volume fraction n is ∝ 1/a³.
fn exponent(scene: &Scene, range: &Range) -> f64 {
    match range.key.as_str() {
        "interaction.alpha" => 1.0,
        "particles.length_mm" if scene.particles.volume_fraction.is_some() => 0.0,
        "particles.length_mm" => 1.0,
        _ => 1.0 / 3.0,
    }
}

/// True if rods interact, and no length in the scene but the rods' own and their distance says anything.
fn of_one_length(scene: &Scene) -> bool {
    let own = scene.particles.rods.as_ref().and_then(|rods| rods.own.as_deref());
    let placed = own.is_some_and(|own| own.length_mm.is_some() || own.place_mm.is_some());
    let interaction = scene.interaction.as_ref();
    interaction.is_some_and(|interaction| interaction.box_mm.is_none() && interaction.min_contact_arm == 0.0)
        && scene.particles.length_sd_percent == 0.0
        && !placed
}

impl Scenes {
    /// Refuses to fit keys that data cannot separate. Rods of one length, in the cube of their
    /// concentration and with contacts at any arm, depend on α, a and n by α·a·n^(1/3) (case `one-length-scale`): each
    /// scene fixes one combination of the logarithms of these keys, and fewer than there are keys are too few.
    pub fn one_length(&self, data: &[Datum]) -> Result<(), SceneError> {
        let sets = 0..self.sets.len();
        let from: Vec<f64> = self.ranges.iter().map(|range| range.from).collect();
        let scenes = sets.clone().map(|set| self.scene(set, &from)).collect::<Result<Vec<_>, _>>()?;
        let lengths: Vec<&Range> = self.ranges.iter().filter(|range| LENGTHS.contains(&&range.key[..])).collect();
        let here = |set: &usize| lengths.iter().any(|range| range.is_of(*set));
        let holds = |set: usize| {
            let in_pa = data.iter().any(|datum| datum.set == set && datum.column.ends_with("_pa"));
            !in_pa && of_one_length(&scenes[set])
        };
        if lengths.is_empty() || !sets.clone().filter(here).all(holds) {
            return Ok(());
        }
        let share = |set: usize, range: usize| {
            exponent(&scenes[set], lengths[range]) * f64::from(u8::from(lengths[range].is_of(set)))
        };
        let known = DMatrix::from_fn(scenes.len(), lengths.len(), share).rank(1e-9);
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
