//! A channel at one time against a swept key.

use super::Drawn;
use crate::files::text::Shown;
use crate::present::plot::{Curve, Figure, names};
use crate::program::Failure;

/// The picture of a sweep with the values of `key` across: the channel at the time `at`, by default that of the last output. There is
/// one curve for each combination of the other keys.
pub(super) fn against(drawn: Drawn, key: &str, at: Option<f64>) -> Result<Figure, Failure> {
    let refused = |what: String| Failure::Input(format!("--x {key}: {what}"));
    let mut curves: Vec<(String, Vec<[f64; 3]>)> = Vec::new();
    let mut times = Vec::new();
    for (curve, run) in drawn.figure.curves.iter().zip(&drawn.runs) {
        let point = run.point.as_deref();
        let point = point.ok_or_else(|| {
            refused(format!("{} is no sweep; a folder of `shearbed sweep` is allowed", run.dir.shown()))
        })?;
        let (value, others) = value(point, key).map_err(refused)?;
        let place = match at {
            None => curve.x.len().checked_sub(1),
            Some(at) => curve.x.iter().position(|time| (time - at).abs() <= 1e-9 * at.abs().max(1.0)),
        };
        let place = place.ok_or_else(|| {
            let at = at.unwrap_or(f64::NAN);
            let near = curve.x.iter().min_by(|a, b| (*a - at).abs().total_cmp(&(*b - at).abs()));
            Failure::Input(format!(
                "--at {at}: {} has no output at this time; the nearest is at {} = {}",
                run.dir.shown(),
                drawn.figure.x_name,
                near.unwrap_or(&f64::NAN)
            ))
        })?;
        times.push(curve.x[place]);
        let half = curve.half_band.as_ref().map_or(f64::NAN, |band| band[place]);
        let own = [value, curve.y[place], half];
        match curves.iter_mut().find(|(same, _)| *same == others) {
            Some((_, points)) => points.push(own),
            None => curves.push((others, vec![own])),
        }
    }
    times.dedup();
    let when = match times[..] {
        [time] => format!("{} = {time}", drawn.figure.x_name),
        _ => "the last output".into(),
    };
    let curve = |(others, mut points): (String, Vec<[f64; 3]>)| {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let column = |k: usize| points.iter().map(|point| point[k]).collect::<Vec<_>>();
        let half = column(2);
        Curve {
            label: if others.is_empty() { drawn.figure.y_name.clone() } else { names::point(&others) },
            x: column(0),
            y: column(1),
            half_band: (!half.iter().any(|half| half.is_nan())).then_some(half),
        }
    };
    Ok(Figure {
        title: format!("{}, {when}", drawn.runs[0].scene.title),
        x_name: names::key(key),
        curves: curves.into_iter().map(curve).collect(),
        ..drawn.figure
    })
}

/// The value of `key` in a point of a sweep, `KEY=VALUE KEY=VALUE`, and the point without it.
fn value(point: &str, key: &str) -> Result<(f64, String), String> {
    let is_key = |word: &&str| word.split_once('=').is_some_and(|(name, _)| name.contains('.'));
    let words: Vec<_> = point.split(' ').collect();
    let own = words.iter().position(|word| word.split_once('=').is_some_and(|(name, _)| name == key));
    let own = own.ok_or_else(|| {
        let keys = words.iter().copied().filter(is_key).filter_map(|word| word.split_once('='));
        let keys: Vec<_> = keys.map(|(name, _)| name).collect();
        format!("the sweep goes over {}, of which one is allowed", keys.join(", "))
    })?;
    let (before, after) = (&words[..own], &words[own + 1..]);
    let number = words[own][key.len() + 1..].parse().ok().filter(|_| after.first().is_none_or(is_key));
    let number = number.ok_or("its values are no numbers; a key with numbers is allowed")?;
    Ok((number, [before, after].concat().join(" ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_has_the_value_of_a_key_and_what_is_left() {
        let point = "interaction.alpha=0.5 particles.orientation=in plane particles.count=20";
        let of = |key| value(point, key);
        assert_eq!(
            of("interaction.alpha"),
            Ok((0.5, "particles.orientation=in plane particles.count=20".into()))
        );
        assert_eq!(
            of("particles.count"),
            Ok((20.0, "interaction.alpha=0.5 particles.orientation=in plane".into()))
        );
        assert_eq!(value("flow.shear_rate_per_s=2", "flow.shear_rate_per_s"), Ok((2.0, String::new())));
        assert!(of("particles.orientation").unwrap_err().starts_with("its values are no numbers"));
        let keys = "the sweep goes over interaction.alpha, particles.orientation, particles.count, of which one is allowed";
        assert_eq!(of("alpha").unwrap_err(), keys);
    }
}
