//! A channel at one time against a swept key.

use super::{Drawn, Run, TIMES};
use crate::Failure;
use crate::derived::{is_extreme, is_of_run, lacks};
use shearbed_validation::files::text::Shown;
use shearbed_validation::oracle::reference::big::finite;
use shearbed_validation::present::plot::{Curve, Figure, names};
use shearbed_validation::serve::sweep::Pairs;

/// What a curve is of: its channel and the other keys.
type Of<'a> = (&'a String, Pairs);

/// The picture of a sweep with the values of `key` across, and a warning about points without a value. Each channel is
/// drawn at the time `at`, by default that of the last output; extremes, which have a time of their own at every point,
/// are those nearest to `at`. There is one curve for each combination of the other keys.
pub(super) fn against(drawn: Drawn, key: &str, at: Option<f64>) -> Result<(Figure, Vec<String>), Failure> {
    let refused = |what: String| Failure::Input(format!("--x {key}: {what}"));
    let Drawn { figure, runs, channels, time, .. } = drawn;
    let mut curves: Vec<(Of<'_>, Vec<[f64; 3]>)> = Vec::new();
    let (mut when, mut left_out) = (Vec::new(), Vec::new());
    for (k, channel) in channels.iter().enumerate() {
        let own: Vec<&Curve> = figure.curves.iter().skip(k).step_by(channels.len()).collect();
        let places = if is_extreme(channel) { extremes(&own, &time, at) } else { outputs(&runs, &own, &figure, at)? };
        let mut times = Vec::new();
        let mut without = Vec::new();
        for ((run, curve), place) in runs.iter().zip(own).zip(places) {
            let point = run.point.as_ref().ok_or_else(|| {
                let (dir, times) = (run.dir.shown(), TIMES.join(", "));
                refused(format!("{dir} is a run: {times} are allowed; a key needs a folder of `shearbed sweep`"))
            })?;
            let (value, others) = value(point, key).map_err(refused)?;
            let Some(place) = place else {
                without.push(names::point(point));
                continue;
            };
            times.push(curve.x[place]);
            let half = curve.half_band.as_ref().map_or(f64::NAN, |band| band[place]);
            let (others, own) = ((channel, others), [value, curve.y[place], half]);
            match curves.iter_mut().find(|(same, _)| *same == others) {
                Some((_, points)) => points.push(own),
                None => curves.push((others, vec![own])),
            }
        }
        let near =
            at.filter(|_| is_extreme(channel)).map_or(String::new(), |at| format!(" near {} = {at}", figure.x_name));
        if times.is_empty() {
            return Err(Failure::Input(format!("--y {channel}: no point has one{near}: {}", lacks(channel))));
        }
        if !without.is_empty() {
            left_out.push(format!("{channel}: points without one{near}: {}", without.join("; ")));
        }
        when.push(time_of(channel, &figure.x_name, times));
    }
    when.dedup();
    when.retain(|when| !when.is_empty());
    let when = when.join("; ");
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
    let figure = Figure {
        title: if when.is_empty() { figure.title } else { format!("{}, {when}", figure.title) },
        x_name: names::key(key),
        curves: curves.into_iter().map(curve).collect(),
        ..figure
    };
    Ok((figure, left_out))
}

/// The time of values at these times, in words.
fn time_of(channel: &str, x_name: &str, mut times: Vec<f64>) -> String {
    if is_of_run(channel) {
        return String::new();
    }
    times.sort_by(f64::total_cmp);
    let texts = times.iter().map(|time| if is_extreme(channel) { format!("{time:.2}") } else { time.to_string() });
    let mut texts: Vec<String> = texts.collect();
    texts.dedup();
    match &texts[..] {
        [time] => format!("{x_name} = {time}"),
        [first, .., last] if is_extreme(channel) => format!("{x_name} = {first} to {last}"),
        _ => "the last output".into(),
    }
}

/// The output of each curve that is nearest to a time.
fn nearest(curve: &Curve, at: f64) -> Option<usize> {
    let off = |place: &usize| (curve.x[*place] - at).abs();
    (0..curve.x.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// The output at the time `at`, by default the last; none of a curve without any.
fn outputs(runs: &[Run], own: &[&Curve], figure: &Figure, at: Option<f64>) -> Result<Vec<Option<usize>>, Failure> {
    let place = |(run, curve): (&Run, &&Curve)| {
        let Some(last) = curve.x.last() else { return Ok(None) };
        let at = at.unwrap_or(*last);
        match nearest(curve, at) {
            Some(place) if (curve.x[place] - at).abs() > 1e-9 * at.abs() => Err(Failure::Input(format!(
                "--at {at}: {} has no output at this time; the nearest is at {} = {}",
                run.dir.shown(),
                figure.x_name,
                curve.x[place]
            ))),
            place => Ok(place),
        }
    };
    runs.iter().zip(own).map(place).collect()
}

/// The extreme within a quarter period of the time `at`; by default of the first after the start that most points have.
fn extremes(own: &[&Curve], time: &str, at: Option<f64>) -> Vec<Option<usize>> {
    // Maxima are half a period apart; in other units than periods they tell how long that is.
    let gaps = own.iter().flat_map(|curve| curve.x.windows(2)).map(|pair| pair[1] - pair[0]);
    let quarter = if time == "t_over_T" { 0.25 } else { gaps.fold(f64::INFINITY, f64::min) / 2.0 };
    let near = |at: f64| {
        let place = |curve: &&Curve| nearest(curve, at).filter(|k| (curve.x[*k] - at).abs() <= quarter);
        own.iter().map(place).collect::<Vec<_>>()
    };
    let count = |at: f64| near(at).iter().flatten().count();
    let most = |most: f64, at: f64| if count(at) > count(most) { at } else { most };
    let longest = own.iter().map(|curve| &curve.x).max_by_key(|x| x.len());
    near(at.unwrap_or_else(|| longest.into_iter().flatten().copied().filter(|time| *time > 0.0).fold(f64::NAN, most)))
}

/// The value of `key` in a point of a sweep, a product of powers of keys, and the other keys than its first.
fn value(point: &Pairs, key: &str) -> Result<(f64, Pairs), String> {
    let mut product = 1.0;
    for factor in key.split('*') {
        let (key, power) = factor.split_once('^').unwrap_or((factor, "1"));
        let (above, below) = power.trim_matches(['(', ')']).split_once('/').unwrap_or((power, "1"));
        let power =
            finite(above).zip(finite(below)).map(|(above, below)| above / below).filter(|power| power.is_finite());
        let power = power.ok_or_else(|| "a power such as 2 or (1/3) is allowed".to_owned())?;
        let (_, number) = point.iter().find(|(name, _)| name == key).ok_or_else(|| {
            let keys: Vec<_> = point.iter().map(|(name, _)| name.as_str()).collect();
            format!("the sweep goes over {}, of which one is allowed", keys.join(", "))
        })?;
        product *= finite(number).ok_or("its values are no numbers; a key with numbers is allowed")?.powf(power);
    }
    if !product.is_finite() {
        return Err(format!("is {product} at a point; finite numbers are allowed"));
    }
    let first = key.split(['*', '^']).next();
    Ok((product, point.iter().filter(|(name, _)| Some(&name[..]) != first).cloned().collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Amplitudes come a little earlier or later at every point, and damped ones end sooner.
    #[test]
    fn extremes_of_one_half_period_are_drawn_together() {
        let curves = [&[0.0, 0.49, 1.0, 1.5][..], &[0.0, 0.52, 0.98], &[0.51], &[]];
        let curves = curves.map(|x| Curve { x: x.to_vec(), ..Curve::default() });
        let of = |time: &str, at| extremes(&curves.iter().collect::<Vec<_>>(), time, at);
        for unit in ["t_over_T", "strain"] {
            assert_eq!(of(unit, None), [Some(1), Some(1), Some(0), None]);
            assert_eq!(of(unit, Some(1.1)), [Some(2), Some(2), None, None]);
            assert_eq!(of(unit, Some(9.0)), [None; 4]);
        }
        let time = |times: &[f64]| time_of("x1_amplitude", "t/T", times.to_vec());
        assert_eq!([time(&[0.52, 0.49, 0.51]), time(&[1.001, 1.003])], ["t/T = 0.49 to 0.52", "t/T = 1.00"]);
    }

    #[test]
    fn a_product_of_powers_is_drawn_across() {
        let point: Pairs =
            [("a", "2"), ("b", "27"), ("c", "word")].map(|(key, value)| (key.into(), value.into())).into();
        let (across, others) = value(&point, "a*b^(1/3)").unwrap();
        assert!((across - 6.0).abs() < 1e-14);
        assert_eq!(others, point[1..]);
        assert_eq!(value(&point, "b^-1").unwrap().0, 1.0 / 27.0);
        for wrong in ["a*d", "a*c", "a^x", "a^(1/0)", "a^", ""] {
            assert!(value(&point, wrong).is_err(), "{wrong}");
        }
    }
}
