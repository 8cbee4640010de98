//! A channel at one time against a swept key.

use super::Drawn;
use crate::Failure;
use shearbed_validation::files::text::Shown;
use shearbed_validation::oracle::reference::big::finite;
use shearbed_validation::present::plot::{Curve, Figure, names};
use shearbed_validation::serve::sweep::Pairs;

/// What a curve is of: its channel and the other keys.
type Of<'a> = (&'a String, Pairs);

/// The picture of a sweep with the values of `key` across: the channel at the time `at`, by default that of the last
/// output. There is one curve for each combination of the other keys.
pub(super) fn against(drawn: Drawn, key: &str, at: Option<f64>) -> Result<Figure, Failure> {
    let refused = |what: String| Failure::Input(format!("--x {key}: {what}"));
    let Drawn { figure, runs, channels, .. } = drawn;
    let mut curves: Vec<(Of<'_>, Vec<[f64; 3]>)> = Vec::new();
    let mut times = Vec::new();
    let pairs = runs.iter().flat_map(|run| channels.iter().map(move |channel| (run, channel)));
    for (curve, (run, channel)) in figure.curves.iter().zip(pairs) {
        let point = run.point.as_ref().ok_or_else(|| {
            refused(format!("{} is no sweep; a folder of `shearbed sweep` is allowed", run.dir.shown()))
        })?;
        let (value, others) = value(point, key).map_err(refused)?;
        let others = (channel, others);
        let at = at.or(curve.x.last().copied()).unwrap_or(f64::NAN);
        let off = |place: &usize| (curve.x[*place] - at).abs();
        let place = (0..curve.x.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        if off(&place) > 1e-9 * at.abs() {
            return Err(Failure::Input(format!(
                "--at {at}: {} has no output at this time; the nearest is at {} = {}",
                run.dir.shown(),
                figure.x_name,
                curve.x[place]
            )));
        }
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
        [time] => format!("{} = {time}", figure.x_name),
        _ => "the last output".into(),
    };
    let curve = |((channel, others), mut points): (Of<'_>, Vec<[f64; 3]>)| {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let column = |k: usize| points.iter().map(|point| point[k]).collect::<Vec<_>>();
        let half = column(2);
        Curve {
            label: match (&others[..], channels.len()) {
                ([], _) => names::channel(channel),
                (_, 1) => names::point(&others),
                _ => format!("{}, {}", names::channel(channel), names::point(&others)),
            },
            x: column(0),
            y: column(1),
            half_band: (!half.iter().any(|half| half.is_nan())).then_some(half),
        }
    };
    Ok(Figure {
        title: format!("{}, {when}", figure.title),
        x_name: names::key(key),
        curves: curves.into_iter().map(curve).collect(),
        ..figure
    })
}

/// The value of `key` in a point of a sweep, and the other keys.
fn value(point: &Pairs, key: &str) -> Result<(f64, Pairs), String> {
    let mut pairs = point.clone();
    let own = pairs.iter().position(|(name, _)| name == key).ok_or_else(|| {
        let keys: Vec<_> = pairs.iter().map(|(name, _)| name.as_str()).collect();
        format!("the sweep goes over {}, of which one is allowed", keys.join(", "))
    })?;
    let (_, number) = pairs.remove(own);
    let number = finite(&number).ok_or("its values are no numbers; a key with numbers is allowed")?;
    Ok((number, pairs))
}
