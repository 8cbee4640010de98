//! Flows one after another from a file, and the density on a grid of angles.

use shearbed_validation::files::csv::Table;
use shearbed_validation::files::{FileError, bounded};
use shearbed_validation::oracle::reference::diffusing::Diffusing;
use shearbed_validation::oracle::reference::motion::Unit;
use shearbed_validation::oracle::reference::table::NoValue;
use std::io::BufReader;
use std::path::Path;

/// The largest number of flows.
const MOST: usize = 10_000;

/// Gradients in 1/s, with durations in s.
type Flows = Vec<([[f64; 3]; 3], f64)>;

/// Reads flows: `duration_s` and `shear_rate_per_s` of u_2 = G x_1, or all of `l11` to `l33`.
pub(super) fn read(path: &Path) -> Result<Flows, FileError> {
    let file = bounded::open(path).map_err(|error| FileError::unreadable(path, &error))?;
    let mut table = Table::new(path, BufReader::new(file))?;
    let gradient: Vec<String> = (0..9).map(|k| format!("l{}{}", k / 3 + 1, k % 3 + 1)).collect();
    let by_rate = table.place("shear_rate_per_s").is_some();
    let names = if by_rate { vec!["shear_rate_per_s".to_owned()] } else { gradient };
    let places: Option<Vec<usize>> = names.iter().map(|name| table.place(name)).collect();
    let (Some(duration), Some(places), true) =
        (table.place("duration_s"), places, table.names().len() == names.len() + 1)
    else {
        let found = shearbed_validation::files::text::line(&table.names().join(","));
        return Err(table.error(format!(
            "the columns are {found}; allowed are duration_s,shear_rate_per_s, or duration_s,l11,l12,l13,l21,l22,l23,\
             l31,l32,l33"
        )));
    };
    let mut flows = Vec::new();
    while let Some(row) = table.next_row()? {
        let mut values = Vec::new();
        for place in &places {
            let rate = row.finite(*place)?;
            if rate != 0.0 && !(1e-100..=1e100).contains(&rate.abs()) {
                return Err(row.refused(*place, "0 or a number with a size from 1e-100 to 1e100"));
            }
            values.push(rate);
        }
        let mut gradient = [[0.0; 3]; 3];
        match values[..] {
            [rate] => gradient[1][0] = rate,
            _ => gradient.as_flattened_mut().copy_from_slice(&values),
        }
        flows.push((gradient, row.positive(duration, "a finite number > 0")?));
        if flows.len() > MOST {
            return Err(row.error(format!("more than {MOST} flows; at most {MOST} are allowed")));
        }
    }
    if flows.is_empty() { Err(table.error("no flow: a row each is needed")) } else { Ok(flows) }
}

/// ψ every 5° in φ and, from axis 3 to the plane of 1 and 2, in θ: the other half is the same. And its stated error.
pub(super) fn density(rods: &Diffusing, times: &[f64], unit: Unit) -> Result<(String, f64), NoValue> {
    let heads = times.iter().map(|time| rods.head(*time, unit)).collect::<Result<Vec<_>, _>>()?;
    let seconds: Vec<f64> = heads.iter().filter_map(|head| head[0]).collect();
    let angles: Vec<(u16, u16)> = (0..=18).flat_map(|j| (0..72).map(move |k| (5 * k, 5 * j))).collect();
    let direction = |(phi, theta): &(u16, u16)| {
        let ((sine, cosine), (along, down)) =
            (f64::from(*phi).to_radians().sin_cos(), f64::from(*theta).to_radians().sin_cos());
        [along * cosine, along * sine, down]
    };
    let directions: Vec<_> = angles.iter().map(direction).collect();
    let (values, error) = rods.densities(&seconds, &directions).map_err(NoValue::Diffusion)?;
    let decimals = (-(2.0 * error.max(1e-12)).log10()).clamp(0.0, 11.0) as usize;
    let mut text = String::from("time_s,phi_deg,theta_deg,psi_per_sr\n");
    for (time_s, values) in seconds.iter().zip(&values) {
        for ((phi, theta), value) in angles.iter().zip(values) {
            text += &format!("{time_s:?},{phi},{theta},{value:.decimals$}\n");
        }
    }
    Ok((text, error))
}
