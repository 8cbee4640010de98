//! Checking how the rods are shaped and where they start: what goes together.

#[cfg(test)]
mod tests;

use super::allowed::Invalid;
use super::particles::equivalent;
use super::{OwnRods, RodsFile, Scene, find};

impl Scene {
    /// Checks that r_e is given once: by itself, or by a cylinder and a formula that gives one for it.
    pub(super) fn check_shape(&self) -> Result<(), Invalid> {
        let particles = &self.particles;
        let key = "particles.shape_correlation";
        let (r, formula) = match (particles.physical_aspect_ratio, particles.shape_correlation) {
            (None, None) => return Ok(()),
            (None, Some(given)) => {
                let allowed = "it goes with physical_aspect_ratio, which is not given";
                return Err(Invalid::new(key, format!("{:?}", given.name()), allowed));
            }
            (Some(r), None) => {
                let words = find(key).map_or_else(String::new, |key| key.holds.to_string());
                let allowed = format!("physical_aspect_ratio = {r} takes {words}");
                return Err(Invalid::missing(key, &allowed));
            }
            (Some(r), Some(correlation)) => (r, correlation.formula()),
        };
        match equivalent(Some(r), particles.shape_correlation) {
            Some(value) if value == particles.aspect_ratio => Ok(()),
            Some(value) => {
                let allowed = format!(
                    "either aspect_ratio or physical_aspect_ratio, of which {} makes {value}",
                    formula.name
                );
                Err(Invalid::new(
                    "particles.aspect_ratio",
                    particles.aspect_ratio,
                    allowed,
                ))
            }
            None => {
                let allowed = format!(
                    "{} ({}) gives no r_e there: above r, or falling as r grows; `shearbed shape` lists what others give",
                    formula.name, formula.formula
                );
                Err(Invalid::new("particles.physical_aspect_ratio", r, allowed))
            }
        }
    }

    /// Checks that the rods of a file are there, and can be those of the scene.
    pub(super) fn check_own_rods(&self) -> Result<(), Invalid> {
        let Some(RodsFile { file, own, .. }) = &self.particles.rods else {
            return Ok(());
        };
        let refused = |allowed: String| {
            let value = format!("{{ file = {file:?} }}");
            Err(Invalid::new("particles.rods", value, allowed))
        };
        let Some(own) = own else {
            return refused(
                "a file's rods where something has read it, as `shearbed run`, `plan` and `sweep` do".into(),
            );
        };
        match self.own_rods_at_odds(own) {
            Some(allowed) => refused(allowed),
            None => Ok(()),
        }
    }

    /// What is allowed of the rods of a file that have something else.
    fn own_rods_at_odds(&self, own: &OwnRods) -> Option<String> {
        let count = self.particles.count;
        let axes = own.p.iter().chain(&own.place_mm).flatten();
        let mut columns = axes.chain(&own.aspect_ratio).chain(&own.length_mm);
        if let Some(column) = columns.find(|column| column.len() != count) {
            let has = column.len();
            return Some(format!(
                "a row for each rod: it has {has}, and particles.count is {count}"
            ));
        }
        let first = |wrong: &dyn Fn(usize) -> bool| (0..count).find(|rod| wrong(*rod));
        if let Some(p) = &own.p {
            let square = |rod: usize| p.iter().map(|axis| axis[rod] * axis[rod]).sum::<f64>();
            // NaN is not within anything.
            let is_unit = |rod: usize| (square(rod) - 1.0).abs() <= 16.0 * f64::EPSILON;
            if let Some(rod) = first(&|rod| !is_unit(rod)) {
                return Some(format!("directions of length 1, which that of rod {rod} is not"));
            }
        }
        if let Some(all) = &own.aspect_ratio {
            let least = if self.interaction.is_some() { 1.0 } else { 0.0 };
            if let Some(rod) = first(&|rod| !(all[rod] > least && all[rod].is_finite())) {
                return Some(format!(
                    "aspect_ratio > {least}, which that of rod {rod}, {}, is not",
                    all[rod]
                ));
            }
        }
        if let Some(all) = &own.length_mm
            && let Some(rod) = first(&|rod| !(all[rod] > 0.0 && all[rod].is_finite()))
        {
            return Some(format!(
                "length_mm > 0, which that of rod {rod}, {}, is not",
                all[rod]
            ));
        }
        let (place, sides) = (own.place_mm.as_ref()?, self.sides_mm()?);
        let outside = |rod: usize| !(0..3).all(|axis| (0.0..=sides[axis]).contains(&place[axis][rod]));
        first(&outside).map(|rod| {
            format!("places in the control volume of {sides:?} mm, which that of rod {rod} is not")
        })
    }

    /// Checks that r_e has the mean that its flow allows, and stays on its side of 1.
    pub(super) fn check_particles(&self) -> Result<(), Invalid> {
        let (r, sd) = (
            self.particles.aspect_ratio,
            self.particles.aspect_ratio_sd_percent,
        );
        if self.interaction.is_some() && r <= 1.0 {
            let allowed = "interacting rods need a number > 1";
            return Err(Invalid::new("particles.aspect_ratio", r, allowed));
        }
        let length_sd = self.particles.length_sd_percent;
        if length_sd >= 100.0 / 3.0 {
            let allowed = "so wide that lengths ≤ 0 are likely; below 33.3333, three standard deviations";
            return Err(Invalid::new("particles.length_sd_percent", length_sd, allowed));
        }
        // Three standard deviations: P(r_e ≤ 1) = 0.0013 per rod.
        let deviation = 3.0 * r * sd / 100.0;
        let too_wide = sd > 0.0 && ((r - 1.0).abs() <= deviation || r <= deviation);
        if too_wide {
            let widest = 100.0 * ((r - 1.0).abs().min(r) / (3.0 * r));
            return Err(Invalid::new(
                "particles.aspect_ratio_sd_percent",
                sd,
                format!(
                    "so wide that r_e ≤ 1 (for discs: r_e ≥ 1 or ≤ 0) is likely; with mean {r} below {widest:.4}, \
                     three standard deviations"
                ),
            ));
        }
        Ok(())
    }
}
