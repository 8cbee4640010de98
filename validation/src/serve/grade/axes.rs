//! Axes in another order: the map between a program's columns and the problem's.

use nalgebra::Vector3;

/// The map from a program's axes to ours (1 gradient, 2 flow, 3 vorticity), with signs for reversed axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// The index of the program's axis for each of our axes, from 0.
    theirs: [usize; 3],
    sign: [f64; 3],
}

/// The names of our axes.
const NAMES: [&str; 3] = ["gradient", "flow", "vorticity"];

impl Default for Axes {
    fn default() -> Self {
        Self { theirs: [0, 1, 2], sign: [1.0; 3] }
    }
}

impl std::str::FromStr for Axes {
    type Err = String;

    /// Parses text such as `flow,gradient,vorticity`: the meaning of the program's axes 1, 2, 3; `-flow` is against the
    /// flow.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut found = [None; 3];
        let words: Vec<_> = text.split(',').map(str::trim).collect();
        for (k, word) in words.iter().enumerate() {
            let (sign, name) = word.strip_prefix('-').map_or((1.0, *word), |name| (-1.0, name));
            let ours = NAMES.iter().position(|axis| *axis == name);
            match ours {
                Some(ours) if found[ours].is_none() => found[ours] = Some((k, sign)),
                _ => return Err(allowed()),
            }
        }
        match (found, words.len()) {
            ([Some(a), Some(b), Some(c)], 3) => Ok(Self { theirs: [a.0, b.0, c.0], sign: [a.1, b.1, c.1] }),
            _ => Err(allowed()),
        }
    }
}

impl std::fmt::Display for Axes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut words = [const { String::new() }; 3];
        for (ours, axis) in NAMES.iter().enumerate() {
            let sign = if self.sign[ours] < 0.0 { "-" } else { "" };
            words[self.theirs[ours]] = format!("{sign}{axis}");
        }
        f.write_str(&words.join(","))
    }
}

fn allowed() -> String {
    "gradient, flow and vorticity are allowed, each once, each with a - before it where it is reversed".to_owned()
}

impl Axes {
    /// A vector in the program's axes.
    pub fn to_theirs(&self, p: [f64; 3]) -> [f64; 3] {
        let mut theirs = [0.0; 3];
        for (k, value) in p.into_iter().enumerate() {
            theirs[self.theirs[k]] = self.sign[k] * value;
        }
        theirs
    }

    /// A vector in the program's axes, in ours.
    pub fn to_ours(&self, p: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| self.sign[k] * p[self.theirs[k]])
    }

    /// A tensor, such as the gradient ∂u_i/∂x_j, in the program's axes.
    pub fn tensor_to_theirs(&self, l: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let mut theirs = [[0.0; 3]; 3];
        for (k, row) in l.into_iter().enumerate() {
            theirs[self.theirs[k]] = self.to_theirs(row).map(|value| self.sign[k] * value);
        }
        theirs
    }

    /// A rate of rotation ω in the program's axes: ω × p is a vector, so ω changes its sign in axes of the other hand.
    pub fn rotation_to_theirs(&self, rotation: [f64; 3]) -> [f64; 3] {
        let spin = Vector3::from(rotation).cross_matrix();
        let l = self.tensor_to_theirs(spin.transpose().into());
        [l[2][1], l[0][2], l[1][0]]
    }

    /// A row of the problem's columns from one that the program wrote in the same columns of its own axes.
    pub(super) fn row_to_ours(&self, columns: &[String], theirs: &[f64]) -> Vec<f64> {
        let sorted = |name: &str| {
            let mut letters: Vec<_> = name.bytes().collect();
            letters.sort_unstable();
            letters
        };
        let of = |column: &String| {
            let (name, sign) = self.theirs(column);
            // A fourth moment is symmetric: its digits have no order.
            let place = columns.iter().position(|other| sorted(other) == sorted(&name));
            place.and_then(|place| theirs.get(place)).map_or(f64::NAN, |value| sign * value)
        };
        columns.iter().map(of).collect()
    }

    /// The program's name of one of the problem's columns, and the sign for its values: `p1` is `p2` if the program's
    /// second axis is the gradient. Columns without an axis keep their names.
    pub fn theirs(&self, column: &str) -> (String, f64) {
        let tail = ["_se", "_per_s"].into_iter().find(|tail| column.ends_with(tail)).unwrap_or("");
        let stem = &column[..column.len() - tail.len()];
        let axis = |digit: u8| usize::from(digit.wrapping_sub(b'1'));
        let digits = stem.bytes().rev().take_while(|byte| (b'1'..=b'3').contains(byte)).count();
        let name = &stem[..stem.len() - digits];
        if ![1, 2, 4].contains(&digits) {
            return (column.to_owned(), 1.0);
        }
        let ours: Vec<_> = stem.bytes().skip(name.len()).map(axis).collect();
        let mut theirs: Vec<_> = ours.iter().map(|axis| self.theirs[*axis] + 1).collect();
        if digits == 2 {
            theirs.sort_unstable();
        }
        let theirs: String = theirs.iter().map(usize::to_string).collect();
        // x1 is a mean of |p_1|, and standard errors have no sign.
        let is_unsigned = name == "x" || tail == "_se";
        let sign = if is_unsigned { 1.0 } else { ours.iter().map(|axis| self.sign[*axis]).product() };
        (format!("{name}{theirs}{tail}"), sign)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_and_gradients_go_there_and_back() {
        let axes: Axes = "flow,-gradient,vorticity".parse().unwrap();
        assert_eq!(axes.to_theirs([1.0, 2.0, 3.0]), [2.0, -1.0, 3.0]);
        assert_eq!(axes.to_ours([2.0, -1.0, 3.0]), [1.0, 2.0, 3.0]);
        // Their first axis is our second, their second our first, reversed.
        let theirs = axes.tensor_to_theirs([[2.0, 3.0, 4.0], [5.0, 6.0, 7.0], [8.0, 9.0, 1.0]]);
        assert_eq!(theirs, [[6.0, -5.0, 7.0], [-3.0, 2.0, -4.0], [9.0, -8.0, 1.0]]);
        assert_eq!(Axes::default().tensor_to_theirs(theirs), theirs);
        let second = ["a11", "a22", "a33", "a12", "a13", "a23"].map(String::from);
        assert_eq!(axes.row_to_ours(&second, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), [2.0, 1.0, 3.0, -4.0, -6.0, 5.0]);
        // A fourth moment is symmetric: a1233 is a2133 of theirs, which they write a1233.
        let fourth = ["a1233", "a1122"].map(String::from);
        assert_eq!(axes.row_to_ours(&fourth, &[7.0, 8.0]), [-7.0, 8.0]);
    }

    #[test]
    fn columns_find_their_names() {
        let axes: Axes = "flow,-gradient,vorticity".parse().unwrap();
        assert_eq!(axes.to_string(), "flow,-gradient,vorticity");
        let turned = "vorticity,gradient,-flow";
        assert_eq!(turned.parse::<Axes>().unwrap().to_string(), turned);
        for (ours, theirs, sign) in [
            ("p1", "p2", -1.0),
            ("p2", "p1", 1.0),
            ("p3", "p3", 1.0),
            ("a11", "a22", 1.0),
            ("a12", "a12", -1.0),
            ("a13", "a23", -1.0),
            ("a1112", "a2221", -1.0),
            ("a1133", "a2233", 1.0),
            ("x1", "x2", 1.0),
            ("x1_se", "x2_se", 1.0),
            ("a_pdot1_per_s", "a_pdot2_per_s", -1.0),
            ("time_step_s", "time_step_s", 1.0),
            ("time_s", "time_s", 1.0),
            ("rod", "rod", 1.0),
        ] {
            assert_eq!(axes.theirs(ours), (theirs.to_owned(), sign));
            assert_eq!(Axes::default().theirs(ours), (ours.to_owned(), 1.0));
        }
        for wrong in ["", "flow", "flow,flow,vorticity", "flow,gradient,up", "flow,gradient,vorticity,flow"] {
            assert!(wrong.parse::<Axes>().is_err(), "{wrong}");
        }
    }
}
