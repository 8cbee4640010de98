//! Checking how the rods are shaped and where they start: what goes together.

#[cfg(test)]
mod tests;

use super::allowed::Invalid;
use super::particles::equivalent;
use super::{OwnRods, RodsFile, Scene, find};

/// A value of a rod in a file that the scene does not allow.
///
/// ```
/// use shearbed::scene::{OwnRods, Scene};
/// let short = OwnRods { length_mm: Some(vec![0.0; 100]), ..OwnRods::default() };
/// let misfit = Scene::default().misfit(&short).expect("no length");
/// assert_eq!((misfit.rod, misfit.column), (0, "length_mm"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The rod, from 0.
    pub rod: usize,
    /// The column that is at fault.
    pub column: &'static str,
    /// What it has.
    pub value: f64,
    /// What is allowed.
    pub allowed: String,
}

/// Allowed lengths of single rods over the scene's: their cubes and the sums of these stay finite.
const OWN_LENGTHS: std::ops::RangeInclusive<f64> = 1e-50..=1e50;

impl Scene {
    /// Checks that r_e is given once: by itself, or by a cylinder and a formula that gives one for it.
    pub(crate) fn check_shape(&self) -> Result<(), Invalid> {
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
                Err(Invalid::new("particles.aspect_ratio", particles.aspect_ratio, allowed))
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

    /// Refuses a file of rods that nothing has read.
    pub(crate) fn check_rods_are_read(&self) -> Result<(), Invalid> {
        match &self.particles.rods {
            Some(RodsFile { file, own: None, .. }) => Err(refused_file(
                file,
                "a file's rods where something has read it, as `shearbed run`, `plan` and `sweep` do".into(),
            )),
            _ => Ok(()),
        }
    }

    /// Checks that the rods of a file are there, and can be those of the scene.
    pub(crate) fn check_own_rods(&self) -> Result<(), Invalid> {
        let Some(RodsFile { file, own: Some(own), .. }) = &self.particles.rods else {
            return Ok(());
        };
        let refused = |allowed: String| Err(refused_file(file, allowed));
        let count = self.particles.count;
        let axes = own.p.iter().chain(&own.place_mm).flatten();
        let mut columns = axes.chain(&own.aspect_ratio).chain(&own.length_mm);
        if let Some(column) = columns.find(|column| column.len() != count) {
            let has = column.len();
            return refused(format!("a row for each rod: it has {has}, and particles.count is {count}"));
        }
        match self.misfit(own) {
            Some(Misfit { rod, column, value, allowed }) => {
                refused(format!("rod {rod} has {column} = {value:?}; allowed: {allowed}"))
            }
            None => Ok(()),
        }
    }

    /// The first rod of a file that this scene cannot have; `None` if it can have all. The columns must be as long as `particles.count`.
    pub fn misfit(&self, own: &OwnRods) -> Option<Misfit> {
        let key = |path| find(path).map(|key| key.holds);
        let shape = key("particles.aspect_ratio");
        let r_e =
            |r: f64| shape.is_some_and(|holds| holds.allows(r)) && (self.interaction.is_none() || r > 1.0);
        let r_e_allowed = match self.interaction {
            Some(_) => "a number > 1, up to 1e100, for interacting rods".to_owned(),
            None => shape.map_or_else(String::new, |holds| holds.to_string()),
        };
        let unit = self.particles.length_mm;
        let length = |length: f64| OWN_LENGTHS.contains(&(length / unit));
        let length_allowed = "a number between 1e-50 and 1e50 times the scene's length_mm";
        let first = |values: &[f64], allowed: &dyn Fn(f64) -> bool, column, words: &str| {
            let rod = values.iter().position(|value| !allowed(*value))?;
            let (value, allowed) = (values[rod], words.to_owned());
            Some(Misfit { rod, column, value, allowed })
        };
        let directions = own.p.as_ref().and_then(|[p1, p2, p3]| {
            let squares: Vec<f64> =
                p1.iter().zip(p2).zip(p3).map(|((a, b), c)| a * a + b * b + c * c).collect();
            // NaN is not within anything.
            let is_unit = |square: f64| (square - 1.0).abs() <= 16.0 * f64::EPSILON;
            first(&squares, &is_unit, "p1² + p2² + p3²", "1")
        });
        let shapes = || first(own.aspect_ratio.as_ref()?, &r_e, "aspect_ratio", &r_e_allowed);
        let lengths = || first(own.length_mm.as_ref()?, &length, "length_mm", length_allowed);
        let places = || {
            let (places, sides) = (own.place_mm.as_ref()?, self.sides_mm()?);
            let names = ["x1_mm", "x2_mm", "x3_mm"];
            let axes = places.iter().zip(sides).zip(names);
            axes.into_iter().find_map(|((place, side), name)| {
                let words = format!("0 to {side} mm, the control volume");
                first(place, &|x| (0.0..=side).contains(&x), name, &words)
            })
        };
        directions.or_else(shapes).or_else(lengths).or_else(places)
    }

    /// Checks that r_e has the mean that its flow allows, and stays on its side of 1.
    pub(crate) fn check_particles(&self) -> Result<(), Invalid> {
        let (r, sd) = (self.particles.aspect_ratio, self.particles.aspect_ratio_sd_percent);
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

fn refused_file(file: &str, allowed: String) -> Invalid {
    Invalid::new("particles.rods", format!("{{ file = {file:?} }}"), allowed)
}
