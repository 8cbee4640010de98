//! Profiles of a model with several minima.

use super::*;

/// b² determines the size of b, a b its sign given that of a, and a is hardly determined: as a passes 0, b changes its
/// sign.
fn two_signs(values: &[f64]) -> Result<Replica, String> {
    let (a, b) = (values[0], values[1]);
    Ok(Replica::whole(move |_| Ok([b * b, a * b, a].map(|value| [value; 3]).to_vec())))
}

fn of_two_signs() -> Fit {
    let points = [(0.49, 0.01), (-0.35, 0.05), (-0.5, 0.6)].into_iter().enumerate();
    let point = |(k, (value, u)): (usize, (f64, f64))| Datum { value, u, ..Datum::place(0, "x1", k as f64) };
    let data: Vec<_> = points.map(point).collect();
    over_box(&data, &Rods::none(1), &["a.a=-1:1", "a.b=-1:1"], &vec![(-1.0, 1.0); 2], &two_signs, 2)
}

#[test]
fn a_profile_changes_to_the_lower_minimum() {
    let fit = of_two_signs();
    let profile = &fit.profiles[0];
    assert!((fit.best.place[0] + 0.5).abs() < 1e-3, "{:?}", fit.best.place);
    for (place, rise) in profile.place.iter().zip(&profile.rise) {
        let inner = (0..=4000).map(|k| fit.best.surface.at(&[*place, f64::from(k) / 2000.0 - 1.0]));
        let least = inner.fold(f64::INFINITY, f64::min) - fit.best.chi_square;
        // A step of 5e-4 in b beside 0.01/(2b) = 0.007: χ² is less by 0.0013 at most in between.
        assert!((rise / profile.shown - least).abs() < 0.002, "{place}: {rise}, {least}");
    }
    // A rise counts less than χ² says, as the model is bent.
    assert!((profile.shown * fit.best.factors[0] - 1.0).abs() < 1e-9 && fit.best.factors[0] > 1.1, "{profile:?}");
    // a = 0.5 with b = −0.7 is 1/0.6 standard deviations from the best place.
    let ends = fit.interval(0, 0.95);
    assert!(ends.low < -0.5 && ends.high > 0.5, "{ends:?}");
}

/// The control: as if the inner minima beyond −0.4 had stayed in the minimum of the best place.
#[test]
fn a_profile_that_jumps_is_no_answer() {
    let mut fit = of_two_signs();
    let mut beyond = |from: f64| {
        for profile in &mut fit.profiles {
            for (place, rise) in profile.place.iter().zip(&mut profile.rise) {
                if *place > from {
                    *rise = 152.0;
                }
            }
        }
        fit.is_smooth()
    };
    // The minimum of the best place alone.
    assert_eq!(beyond(0.0), Ok(()));
    let said = beyond(-0.4).unwrap_err().to_string();
    assert!(said.contains("a.a") && said.contains("jumps"), "{said}");
}

/// Values between two minima are in no interval, and an interval from one minimum to the other would contain them.
#[test]
fn two_minima_are_no_answer() {
    let said = of_two_signs().is_smooth().unwrap_err().to_string();
    assert!(said.contains("a.a: χ² has several minima") && said.contains("-0.63"), "{said}");
}
