//! The measured points of a scene's experiment, if the user supplies them.

use super::*;
use crate::input::experiment::{self, Measured};

/// Adds the measured points of a scene to its figure, and returns a sentence on them for the caption.
pub(super) fn measured(scene: &str, effort: &Effort, figure: &mut Figure) -> Result<String, String> {
    let all = experiment::points_for(effort.data.as_deref(), scene).map_err(|error| error.to_string())?;
    if all.is_empty() {
        return Ok("No measured points.".into());
    }
    for observable in ["x1", "x2", "x3"] {
        let here: Vec<_> = all.iter().filter(|point| point.observable == observable).collect();
        let mut labels: Vec<&str> = here.iter().map(|point| point.label.as_str()).collect();
        labels.dedup();
        for label in labels {
            let points = here.iter().copied().filter(|point| point.label == label);
            figure.points.push(series(label, observable, &points.collect::<Vec<_>>()));
        }
    }
    let mut sources: Vec<&str> = all.iter().map(|point| point.label.as_str()).collect();
    sources.dedup();
    Ok(format!("Points with bars of 95 %: {}.", sources.join("; ")))
}

fn series(label: &str, observable: &str, points: &[&Measured]) -> Points {
    /// Standard deviations in half of a 95 % interval of a normal distribution.
    const WIDTH: f64 = 1.96;
    let label = format!("X̄_{}, {label}", observable.trim_start_matches('x'));
    Points {
        x_error: Some(points.iter().map(|point| WIDTH * point.u_x).collect()),
        ..Points::with_bars(label, points, |point| (point.x, point.y, WIDTH * point.u_y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_synthetic_point_has_bars_of_95_percent() {
        let point = Measured { label: "synthetic".into(), observable: "x3", x: 1.0, y: 0.25, u_x: 0.01, u_y: 0.02 };
        let points = series("synthetic", "x3", &[&point]);
        assert_eq!(points.label, "X̄_3, synthetic");
        assert_eq!((points.x, points.y), (vec![1.0], vec![0.25]));
        assert_eq!(points.x_error, Some(vec![0.0196]));
        assert_eq!(points.y_error, Some(vec![0.0392]));
    }
}
