//! Checks which rods of a file a scene allows.

use super::{OwnRods, Scene, find};

/// A value of a rod in a file that the scene does not allow.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// Index of the rod, from 0.
    pub rod: usize,
    /// Name of the column with the value.
    pub column: &'static str,
    /// The value of the rod.
    pub value: f64,
    /// The allowed values, in words.
    pub allowed: String,
}

/// Allowed lengths of single rods over the scene's, such that their cubes and sums of cubes stay finite.
const OWN_LENGTHS: std::ops::RangeInclusive<f64> = 1e-50..=1e50;

impl Scene {
    /// The first rod of a file that this scene does not allow, or `None`. The columns must be as long as
    /// `particles.count`.
    pub fn misfit(&self, own: &OwnRods) -> Option<Misfit> {
        let key = |path| find(path).map(|key| key.holds);
        let shape = key("particles.aspect_ratio");
        let r_e = |r: f64| shape.is_some_and(|holds| holds.allows(r)) && (self.interaction.is_none() || r > 1.0);
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
            let squares: Vec<f64> = p1.iter().zip(p2).zip(p3).map(|((a, b), c)| a * a + b * b + c * c).collect();
            // NaN fails this comparison too.
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
}
