//! Traces: a_kk = 1, da_kk/dt = 0 and a_ijkk = a_ij, in any flow and with any closure.

use super::answer::Answer;
use crate::judge::statistics::worst;
use crate::methods::tensors::fourth::PAIRS;
use crate::serve::problems::LoadedProblem;
use crate::serve::problems::formula::paired;

/// Six printed digits and an integrator's drift change a trace by less, in units of the largest component.
const OFF: f64 = 1e-3;

/// What is wrong with the traces in a row, if anything is.
pub(super) fn remark(loaded: &LoadedProblem, answer: &Answer, row: usize) -> Option<String> {
    let names = &loaded.problem.columns[loaded.problem.kind.keys().len()..];
    let begins = |with: &[&str]| with.iter().zip(names).filter(|(due, name)| *due == name).count() == with.len();
    let input = loaded.inputs.as_ref().map(|inputs| &inputs.rows[row][1..]);
    match input {
        _ if begins(&["a11", "a22", "a33"]) => of_second(answer, row).or_else(|| {
            // A program that has ended early writes on what it has.
            let stays = row > 0 && answer.rows[row] == answer.rows[row - 1];
            stays.then(|| "all numbers are those of the row before".to_owned())
        }),
        _ if begins(&["dadt11_per_s", "dadt22_per_s", "dadt33_per_s"]) => of_rate(&answer.rows[row]),
        Some(a) if begins(&["a1111", "a1122", "a1133", "a1112"]) => of_fourth(&answer.rows[row], a),
        _ => None,
    }
}

fn trace(values: &[f64]) -> f64 {
    values[0] + values[1] + values[2]
}

fn of_second(answer: &Answer, row: usize) -> Option<String> {
    let (values, is_one) = (&answer.rows[row], |sum: f64| (sum - 1.0).abs() <= OFF);
    let found = trace(values);
    if is_one(found) {
        return None;
    }
    let digits = if found.abs() < 1e4 { format!("{found:.4}") } else { format!("{found:.1e}") };
    let others = || (0..values.len()).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| [i, j, k])));
    let permuted = others().any(|of| is_one(of.iter().map(|k| values[*k]).sum()));
    let first = trace(&answer.rows[0]);
    Some(match (row > 0 && is_one(first), permuted) {
        (true, _) => {
            format!("the trace drifts from {first:.4} to {digits}: its rate has a trace, or digits are too few")
        }
        (false, true) => format!("the trace is {digits}; are the columns in another order?"),
        (false, false) => format!("the trace is {digits}, where 1 is due"),
    })
}

fn of_rate(values: &[f64]) -> Option<String> {
    let (found, size) = (trace(values), worst(values.iter().map(|x| x.abs())));
    (found.abs() > OFF * size).then(|| format!("the trace of da_ij/dt is {found:.4} 1/s, where 0 is due"))
}

/// The a_ijkk that is farthest from a_ij, the first six numbers of `a`.
fn of_fourth(values: &[f64], a: &[f64]) -> Option<String> {
    let of = |pair: usize| (0..3).map(|k| values[paired(pair, k)]).sum::<f64>();
    let off = |pair: &usize| (of(*pair) - a[*pair]).abs();
    let pair = (0..6).max_by(|p, q| off(p).total_cmp(&off(q))).filter(|pair| off(pair) > OFF)?;
    let ((i, j), found, due) = (PAIRS[pair], of(pair), a[pair]);
    let ij = format!("{}{}", i + 1, j + 1);
    Some(format!("a_{ij}11 + a_{ij}22 + a_{ij}33 is {found:.4}, where a_{ij} = {due:.4} is due"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::problems::loaded;

    #[test]
    fn each_kind_of_tensor_has_its_trace() {
        for (name, due) in [
            ("closed-ft-hybrid-mixed", "the trace is 1.1000, where 1 is due"),
            ("dadt-ft-hybrid", "the trace of da_ij/dt is 0.1000 1/s, where 0 is due"),
            ("closure-hybrid", "a_1111 + a_1122 + a_1133 is "),
        ] {
            let loaded = loaded(name);
            let mut answer = Answer::certified(&loaded);
            for row in 0..answer.rows.len() {
                assert_eq!(remark(&loaded, &answer, row), None, "{name} {row}");
            }
            answer.rows[0][0] += 0.1;
            let said = remark(&loaded, &answer, 0).unwrap();
            assert!(said.starts_with(due), "{said}");
        }
    }
}
