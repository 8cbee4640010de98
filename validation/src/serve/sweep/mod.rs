//! A sweep: one scene at every point of a grid of key values.

mod axis;
mod folder;

pub(crate) use axis::key_and_text;
pub use axis::{Axis, KeyValue, MAX_POINTS, shown};
pub use folder::{Folder, POINT, Points, inputs, point_name, smaller};

use crate::input::start::Starts;
use shearbed::scene::document::Document;
use shearbed::scene::{self, of_document};
use shearbed::{Error, Plan, Scene};
use toml::Value;

/// A point of the grid.
pub struct Point {
    /// The value of each axis.
    pub values: Vec<Value>,
    /// The plan to run.
    pub plan: Plan,
}

/// Why a scene has no grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// The text of the scene is refused.
    #[error("{0}")]
    Scene(String),
    /// The grid is too large.
    #[error("more than {MAX_POINTS} points; at most {MAX_POINTS} are allowed")]
    TooMany,
    /// A point is refused.
    #[error("{point} (point {number} of {count}): {why}")]
    Point {
        /// Its keys and values.
        point: String,
        /// Its number, from 1.
        number: usize,
        /// The number of points.
        count: usize,
        /// The reason.
        why: String,
    },
}

/// Every point of the grid, the last axis varying fastest, checked like a scene file. `fixed` are keys that all points
/// have in place of the scene's own; `starts` belong to the scene's folder.
///
/// # Errors
///
/// Too many points, or the first that is refused.
pub fn points(text: &str, starts: &Starts, fixed: &[KeyValue], axes: &[Axis]) -> Result<Vec<Point>, GridError> {
    let base = document(text).map_err(GridError::Scene)?;
    let count = count(axes).ok_or(GridError::TooMany)?;
    let mut starts = starts.clone();
    let point = |k| {
        let values = at(axes, k);
        let own = axes.iter().map(|axis| axis.key.as_str()).zip(values.iter().cloned());
        let plan = with(&base, fixed.iter().map(KeyValue::pair).chain(own)).and_then(|mut scene| {
            starts.fill(&mut scene)?;
            Plan::new(&scene).map_err(|error| error.to_string())
        });
        let refused = |why| GridError::Point { point: described(axes, &values), number: k + 1, count, why };
        Ok(Point { plan: plan.map_err(refused)?, values })
    };
    (0..count).map(point).collect()
}

/// The number of points of a grid; `None` if there are too many.
pub fn count(axes: &[Axis]) -> Option<usize> {
    let count = axes.iter().try_fold(1_usize, |count, axis| count.checked_mul(axis.values.len()));
    count.filter(|count| *count <= MAX_POINTS)
}

/// The keys of a point and the texts of their values.
pub type Pairs = Vec<(String, String)>;

/// The keys and `values` of a point.
pub fn pairs(axes: &[Axis], values: &[Value]) -> Pairs {
    axes.iter().zip(values).map(|(axis, value)| (axis.key.clone(), shown(value))).collect()
}

/// The description of a point: `interaction.alpha=0.3 particles.count=10`.
pub fn described(axes: &[Axis], values: &[Value]) -> String {
    let words: Vec<_> = pairs(axes, values).iter().map(|(key, value)| format!("{key}={value}")).collect();
    words.join(" ")
}

/// The values of point `k`, counted from 0.
pub fn at(axes: &[Axis], mut k: usize) -> Vec<Value> {
    let mut values = Vec::new();
    for axis in axes.iter().rev() {
        values.push(axis.values[k % axis.values.len()].clone());
        k /= axis.values.len();
    }
    values.reverse();
    values
}

/// The scene in `text` with the keys `settings`, checked like a scene file.
pub fn scene_with(text: &str, settings: &[KeyValue]) -> Result<Scene, String> {
    with(&document(text)?, settings.iter().map(KeyValue::pair))
}

fn with<'a>(base: &Document, mut settings: impl Iterator<Item = (&'a str, Value)>) -> Result<Scene, String> {
    let mut document = base.clone();
    let set = |(key, value)| scene::set(&mut document, key, value);
    settings.try_for_each(set).and_then(|()| of_document(&document)).map_err(messages)
}

fn document(text: &str) -> Result<Document, String> {
    Document::parse("", text).map_err(messages)
}

fn messages(error: Error) -> String {
    error.messages().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::scenes;

    fn text() -> &'static str {
        scenes::find("fig4-n50").unwrap().text
    }

    fn refused(over: &[&str]) -> String {
        let axes: Vec<_> = over.iter().map(|text| Axis::parse(text).unwrap()).collect();
        points(text(), &Starts::default(), &[], &axes).err().unwrap().to_string()
    }

    #[test]
    fn the_grid_is_full_and_its_numbers_reach_the_scene_bit_for_bit() {
        let over = ["interaction.alpha=0.1:0.7:7", "particles.count=10,20"];
        let axes = over.map(|text| Axis::parse(text).unwrap());
        let found =
            points(text(), &Starts::default(), &[KeyValue::parse("ensemble.replicas=3").unwrap()], &axes).unwrap();
        assert_eq!(found.len(), 14);
        for (k, point) in found.iter().enumerate() {
            let scene = point.plan.scene();
            let alpha = (k / 2 + 1) as f64 / 10.0;
            assert_eq!(scene.interaction.as_ref().unwrap().alpha, alpha);
            assert_eq!((scene.particles.count, scene.ensemble.replicas), (10 * (k % 2 + 1), 3));
        }
    }

    #[test]
    fn every_point_is_checked_as_a_scene_file_is() {
        for (over, expected) in [
            (
                &["particles.count=10:20:4"][..],
                "particles.count=13.333333333333334 (point 2 of 4): particles.count = 13.333333333333334 is not \
                 allowed: expected a whole number from 1 to 100000000",
            ),
            (&["interaction.alpa=1,2"], "unknown key `alpa`, expected one of"),
            (&["interaction.update=angels"], "\"rotation\", \"angles\" or \"kick\""),
            (&["title.x=1"], "title is not a table: it has no key x"),
            (&["a=1:2:1000", "b=1:2:101"], "more than 100000 points"),
        ] {
            let error = refused(over);
            assert!(error.contains(expected), "{error}");
        }
    }
}
