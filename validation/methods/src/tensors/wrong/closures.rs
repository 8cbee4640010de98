//! Known mistakes in closures: what a wrong code has in place of a_ijkl.

use crate::tensors::closures::{TERMS, aligned, linear, linear_by, mixed, quadratic, weighted};
use crate::tensors::polynomials::{INVARIANT, XY, terms};
use crate::tensors::{Closure, Fourth, ibof, orthotropic};
use nalgebra::Matrix3;
use std::sync::{Arc, LazyLock};

/// a_ijkl from a_ij.
type Form = fn(&Matrix3<f64>) -> Fourth;
type Formed = Arc<dyn Fn(&Matrix3<f64>) -> Fourth + Send + Sync>;
/// a_ijkl from the numbers of a closure and a_ij.
type ByNumbers = Arc<dyn Fn(&[f64], &Matrix3<f64>) -> Fourth + Send + Sync>;
/// A name and a change.
type Named<T> = (&'static str, fn(&mut T));

/// What stands for a_ijkl in a code.
#[derive(Clone)]
pub struct Stand {
    /// Its name, to stand after "this is the curve of".
    pub name: String,
    /// The closure that a code with this mistake inside meant; `None` for one that may stand for any other.
    pub of: Option<Closure>,
    fourth: Formed,
}

impl Stand {
    /// a_ijkl from a_ij.
    pub fn fourth(&self, a: &Matrix3<f64>) -> Fourth {
        (self.fourth)(a)
    }
}

/// The number of closures that are met with a second mistake too; those after them are tried alone.
pub const WITH_OTHERS: usize = 24;

/// Every closure, right and wrong ones.
pub static CLOSURES: LazyLock<Vec<Stand>> = LazyLock::new(|| {
    let listed = LISTED.map(|(name, fourth)| Stand { name: name.to_owned(), of: None, fourth: Arc::new(fourth) });
    listed.into_iter().chain(Closure::ALL.into_iter().flat_map(inside)).collect()
});

const LISTED: [(&str, Form); 37] = [
    ("the linear closure", linear),
    ("the quadratic closure", quadratic),
    ("the hybrid closure", |a| Closure::Hybrid.fourth(a)),
    ("the natural closure", |a| Closure::Natural.fourth(a)),
    ("the ORE closure", |a| Closure::Ore.fourth(a)),
    ("the ORW closure", |a| Closure::Orw.fourth(a)),
    ("the IBOF closure", |a| Closure::Ibof.fourth(a)),
    ("the ORF closure (Cintra & Tucker 1995)", |a| orthotropic::ORF_FIT.fourth(a)),
    ("the quadratic closure made symmetric in all indices", symmetric),
    ("a·D·a for 𝔸:D (a_ik a_jl for a_ij a_kl)", |a| {
        Fourth::from_fn(|i, j, k, l| 0.5 * (a[(i, k)] * a[(j, l)] + a[(i, l)] * a[(j, k)]))
    }),
    ("a linear closure with + 1/35 for − 1/35", |a| linear_by(a, 7.0, -35.0)),
    ("a linear closure without its term of 1/35", |a| linear_by(a, 7.0, f64::INFINITY)),
    ("a linear closure with its 1/7 before both brackets", |a| linear_by(a, 7.0, 245.0)),
    ("a hybrid closure with f and 1 − f exchanged", |a| mixed(a, 1.0 - aligned(a), linear)),
    ("a hybrid closure with f = (3 a:a − 1)/2", |a| mixed(a, 1.5 * a.dot(a) - 0.5, linear)),
    ("a hybrid closure with + 1/35 for − 1/35", |a| mixed(a, aligned(a), |a| linear_by(a, 7.0, -35.0))),
    ("a hybrid closure with (1 + f) linear − f quadratic", |a| mixed(a, -aligned(a), linear)),
    ("the linear closure of rods in a plane (1/6, − 1/24)", planar),
    ("the hybrid closure of rods in a plane (1/6, − 1/24, f = 1 − 4(a_11 a_22 − a_12²))", |a| {
        mixed(a, 1.0 - 4.0 * in_plane(a), planar)
    }),
    ("a hybrid closure with 1/6 and − 1/24", |a| mixed(a, aligned(a), planar)),
    ("a hybrid closure with f = 1 − 4(a_11 a_22 − a_12²)", |a| mixed(a, 1.0 - 4.0 * in_plane(a), linear)),
    ("a hybrid closure with f = 1 − 4 det a", |a| mixed(a, 1.0 - 4.0 * a.determinant(), linear)),
    ("a hybrid closure with f = 1 − 9 det a", |a| mixed(a, 1.0 - 9.0 * a.determinant(), linear)),
    ("a hybrid closure with f = 2 a:a − 1", |a| mixed(a, 2.0 * a.dot(a) - 1.0, linear)),
    ("a linear closure without its term of 1/7", |a| linear_by(a, f64::INFINITY, 35.0)),
    ("a linear closure with 1 for 1/7", |a| linear_by(a, 1.0, 35.0)),
    ("a linear closure with 1/35 for 1/7", |a| linear_by(a, 35.0, 35.0)),
    ("a linear closure with 1/7 for 1/35", |a| linear_by(a, 7.0, 7.0)),
    ("a hybrid closure with 1 for 1/7", |a| mixed(a, aligned(a), |a| linear_by(a, 1.0, 35.0))),
    ("a hybrid closure with 1/35 for 1/7", |a| mixed(a, aligned(a), |a| linear_by(a, 35.0, 35.0))),
    ("a hybrid closure with 1/7 for 1/35", |a| mixed(a, aligned(a), |a| linear_by(a, 7.0, 7.0))),
    ("a hybrid closure f (quadratic + (1 − f) linear)", |a| {
        Fourth((quadratic(a).0 + linear(a).0 * (1.0 - aligned(a))) * aligned(a))
    }),
    ("a hybrid closure f quadratic + 1 − f linear", |a| {
        Fourth(((quadratic(a).0 - linear(a).0) * aligned(a)).add_scalar(1.0))
    }),
    ("a hybrid closure with f = 1 + 27 det a", |a| mixed(a, 2.0 - aligned(a), linear)),
    ("a hybrid closure with f² for f", |a| mixed(a, aligned(a).powi(2), linear)),
    ("a hybrid closure with a_11 a_22 a_33 for det a", |a| {
        mixed(a, 1.0 - 27.0 * a.diagonal().iter().product::<f64>(), linear)
    }),
    ("a hybrid closure with a_ik a_jl for a_ij a_kl, or 𝔸 contracted over i and k", |a| {
        let f = aligned(a);
        let crossed = Fourth::from_fn(|i, j, k, l| a[(i, k)] * a[(j, l)]);
        Fourth(crossed.0 * f + linear(a).0 * (1.0 - f))
    }),
];

/// The linear closure with the numbers of rods in a plane.
fn planar(a: &Matrix3<f64>) -> Fourth {
    linear_by(a, 6.0, 24.0)
}

/// The determinant of a in the plane 12.
fn in_plane(a: &Matrix3<f64>) -> f64 {
    a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(0, 1)]
}

fn symmetric(a: &Matrix3<f64>) -> Fourth {
    Fourth::from_fn(|i, j, k, l| (a[(i, j)] * a[(k, l)] + a[(i, k)] * a[(j, l)] + a[(i, l)] * a[(j, k)]) / 3.0)
}

/// Mistakes inside a fitted closure.
fn inside(closure: Closure) -> Vec<Stand> {
    let stand = |what: String, fourth: Formed| {
        let name = format!("the {} closure {what}", closure.name());
        Stand { name, of: Some(closure), fourth }
    };
    let axes = |fit: &orthotropic::Fit| -> Vec<Stand> {
        let changed = |(what, change): &Named<orthotropic::Fit>| {
            let mut fit = fit.clone();
            change(&mut fit);
            stand((*what).to_owned(), Arc::new(move |a| fit.fourth(a)))
        };
        let changes = in_coefficients(&fit.coefficients, fit.powers, XY).into_iter().map(|(what, coefficients)| {
            let fit = orthotropic::Fit { coefficients, ..fit.clone() };
            stand(what, Arc::new(move |a| fit.fourth(a)))
        });
        IN_AXES.iter().map(changed).chain(changes).collect()
    };
    match closure {
        Closure::Ore => axes(&orthotropic::ORE_FIT),
        Closure::Orw => axes(&orthotropic::ORW_FIT),
        Closure::Ibof => {
            let right = &*ibof::FIT;
            let changed = |(what, change): &Named<ibof::Fit>| {
                let mut fit = right.clone();
                change(&mut fit);
                stand((*what).to_owned(), Arc::new(move |a| fit.fourth(a)))
            };
            let changes = in_coefficients(&right.coefficients, &right.powers, INVARIANT);
            let changes = changes.into_iter().map(|(what, coefficients)| {
                let fit = ibof::Fit { coefficients, ..right.clone() };
                stand(what, Arc::new(move |a| fit.fourth(a)))
            });
            IN_INVARIANTS.iter().map(changed).chain(changes).collect()
        }
        _ => Vec::new(),
    }
}

/// One name of four changes: an eigenvector has no sign, and here the four pairs of signs differ.
const TRANSPOSED: &str = "with Rᵀ for R (rows of the eigenvectors for columns)";

/// Rᵀ with these signs of the first two eigenvectors; that of the third changes nothing more.
fn turned_back(axes: Matrix3<f64>, [x, y]: [f64; 2]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&[x, y, 1.0].into()) * axes.transpose()
}

/// Mistakes in the axes of ORE and ORW.
const IN_AXES: [Named<orthotropic::Fit>; 24] = [
    ("with x ≤ y ≤ z, the eigenvalues in ascending order", |fit| (fit.values, fit.axes) = ([2, 1, 0], [2, 1, 0])),
    ("with the eigenvalues in ascending order, and their axes in descending order", |fit| fit.values = [2, 1, 0]),
    ("with the axes of the eigenvalues in the reverse order", |fit| fit.axes = [2, 1, 0]),
    ("with the first and the second axis exchanged", |fit| fit.axes = [1, 0, 2]),
    ("with the second and the third axis exchanged", |fit| fit.axes = [0, 2, 1]),
    (TRANSPOSED, |fit| fit.turn = |axes| turned_back(axes, [1.0, 1.0])),
    (TRANSPOSED, |fit| fit.turn = |axes| turned_back(axes, [-1.0, 1.0])),
    (TRANSPOSED, |fit| fit.turn = |axes| turned_back(axes, [1.0, -1.0])),
    (TRANSPOSED, |fit| fit.turn = |axes| turned_back(axes, [-1.0, -1.0])),
    ("with twice a_1122, a_1133 and a_2233 in the axes of a", |fit| fit.mixed = |mixed| mixed.map(|x| 2.0 * x)),
    ("with half of a_1122, a_1133 and a_2233 in the axes of a", |fit| fit.mixed = |mixed| mixed.map(|x| 0.5 * x)),
    ("with a_1122 and a_1133 exchanged in the axes of a", |fit| fit.mixed = |[x, y, z]| [x, z, y]),
    ("with a_1122 and a_2233 exchanged in the axes of a", |fit| fit.mixed = |[x, y, z]| [z, y, x]),
    ("with a_1133 and a_2233 exchanged in the axes of a", |fit| fit.mixed = |[x, y, z]| [y, x, z]),
    ("left in the axes of a", |fit| fit.turn = |_| Matrix3::identity()),
    ("with the polynomials of a_1111 and a_2222 exchanged", |fit| fit.polynomials = [1, 0, 2]),
    ("with the polynomials of a_1111 and a_3333 exchanged", |fit| fit.polynomials = [2, 1, 0]),
    ("with the polynomials of a_2222 and a_3333 exchanged", |fit| fit.polynomials = [0, 2, 1]),
    ("with the polynomials of a_2222, a_3333, a_1111 for a_1111, a_2222, a_3333", |fit| fit.polynomials = [1, 2, 0]),
    ("with the polynomials of a_3333, a_1111, a_2222 for a_1111, a_2222, a_3333", |fit| fit.polynomials = [2, 0, 1]),
    ("with x and y exchanged", |fit| fit.arguments = [1, 0]),
    ("with the largest and the smallest eigenvalue for x and y", |fit| fit.arguments = [0, 2]),
    ("with the second and the smallest eigenvalue for x and y", |fit| fit.arguments = [1, 2]),
    ("with the smallest and the second eigenvalue for x and y", |fit| fit.arguments = [2, 1]),
];

/// Mistakes in the invariants and in the β of IBOF.
const IN_INVARIANTS: [Named<ibof::Fit>; 20] = [
    ("with II = a:a", |fit| fit.invariants = |a| [a.dot(a), a.determinant()]),
    ("with II = a:a/2", |fit| fit.invariants = |a| [0.5 * a.dot(a), a.determinant()]),
    ("with II = 1 − a:a", |fit| fit.invariants = |a| [1.0 - a.dot(a), a.determinant()]),
    ("with II = (a:a − 1)/2", |fit| fit.invariants = |a| [0.5 * (a.dot(a) - 1.0), a.determinant()]),
    ("with II = (1 + a:a)/2", |fit| fit.invariants = |a| [0.5 * (a.dot(a) + 1.0), a.determinant()]),
    ("with III = tr a³", |fit| fit.invariants = |a| [0.5 * (1.0 - a.dot(a)), (a * a * a).trace()]),
    ("with III = tr a³/3", |fit| fit.invariants = |a| [0.5 * (1.0 - a.dot(a)), (a * a * a).trace() / 3.0]),
    ("with III = −det a", |fit| fit.invariants = |a| [0.5 * (1.0 - a.dot(a)), -a.determinant()]),
    ("with II = a:a and III = tr a³", |fit| fit.invariants = |a| [a.dot(a), (a * a * a).trace()]),
    ("with II and III exchanged", |fit| fit.powers = fit.powers.map(|(m, n)| (n, m))),
    ("with II and III exchanged, also in β1, β2 and β5", |fit| {
        fit.invariants = |a| [a.determinant(), 0.5 * (1.0 - a.dot(a))];
    }),
    ("with β3 and β4 exchanged", |fit| fit.places = [0, 1, 3, 2, 4, 5]),
    ("with β4 and β6 exchanged", |fit| fit.places = [0, 1, 2, 5, 4, 3]),
    ("with β3 and β6 exchanged", |fit| fit.places = [0, 1, 5, 3, 4, 2]),
    ("with β4 and β5 exchanged", |fit| fit.places = [0, 1, 2, 4, 3, 5]),
    ("with β5 and β6 exchanged", |fit| fit.places = [0, 1, 2, 3, 5, 4]),
    ("with the polynomials of β3 and β4 exchanged, also in β1, β2 and β5", |fit| exchange(fit, 0, 1)),
    ("with the polynomials of β3 and β6 exchanged, also in β1, β2 and β5", |fit| exchange(fit, 0, 2)),
    ("with the polynomials of β4 and β6 exchanged, also in β1, β2 and β5", |fit| exchange(fit, 1, 2)),
    ("without symmetrisation over i, j, k, l", |fit| fit.pairings = 1),
];

fn exchange(fit: &mut ibof::Fit, one: usize, other: usize) {
    for k in 0..fit.powers.len() {
        fit.coefficients.swap(one * fit.powers.len() + k, other * fit.powers.len() + k);
    }
}

/// Coefficients of three polynomials in fewer digits, without one term, and with two terms exchanged, with words for
/// each.
fn in_coefficients(right: &[f64], powers: &[(i32, i32)], letters: [&str; 2]) -> Vec<(String, Vec<f64>)> {
    let terms = &terms(powers, letters);
    let digits = (2..11).map(|digits| {
        let round = |c: &f64| format!("{c:.*e}", digits - 1).parse().unwrap_or(*c);
        (format!("with coefficients of {digits} digits"), right.iter().map(round).collect())
    });
    let decimals = (1..7).map(|decimals| {
        let round = |c: &f64| format!("{c:.decimals$}").parse().unwrap_or(*c);
        (format!("with coefficients of {decimals} decimals"), right.iter().map(round).collect())
    });
    let single = |c: &f64| f64::from(*c as f32);
    let single = ("with coefficients in single precision".to_owned(), right.iter().map(single).collect());
    let without = terms.iter().enumerate().map(|(left_out, term)| {
        let others = right.iter().enumerate().map(|(k, c)| if k % terms.len() == left_out { 0.0 } else { *c });
        let term = if term.is_empty() { "constant" } else { term };
        (format!("without the terms {term} of its three polynomials"), others.collect())
    });
    let mirrored = |&(m, n): &(i32, i32)| powers.iter().position(|other| m > n && *other == (n, m));
    let exchanged = powers.iter().enumerate().filter_map(|(k, power)| Some((k, mirrored(power)?))).map(|(k, other)| {
        let mut coefficients = right.to_vec();
        coefficients.chunks_mut(powers.len()).for_each(|row| row.swap(k, other));
        (format!("with its terms {} and {} exchanged", terms[k], terms[other]), coefficients)
    });
    let mut all: Vec<(_, Vec<f64>)> = Vec::new();
    for (words, coefficients) in digits.chain(decimals).chain([single]).chain(without).chain(exchanged) {
        if coefficients != right && all.iter().all(|(_, known)| *known != coefficients) {
            all.push((words, coefficients));
        }
    }
    all
}

/// A closure as it is with other numbers in it; it is linear in each.
pub struct Numbered {
    /// The numbers, each with what it stands before.
    pub numbers: Vec<(String, f64)>,
    form: ByNumbers,
}

impl Numbered {
    /// a_ijkl with other values of some numbers.
    pub fn fourth(&self, others: &[(usize, f64)], a: &Matrix3<f64>) -> Fourth {
        let mut numbers: Vec<_> = self.numbers.iter().map(|(_, number)| *number).collect();
        for (k, value) in others {
            numbers[*k] = *value;
        }
        (self.form)(&numbers, a)
    }

    /// What stands for a_ijkl with another value of one number.
    pub fn stand(&self, of: Closure, number: usize, value: f64) -> Stand {
        let mut numbers: Vec<_> = self.numbers.iter().map(|(_, number)| *number).collect();
        numbers[number] = value;
        let form = self.form.clone();
        Stand { name: String::new(), of: Some(of), fourth: Arc::new(move |a| form(&numbers, a)) }
    }

    fn new(
        numbers: impl IntoIterator<Item = (String, f64)>,
        form: impl Fn(&[f64], &Matrix3<f64>) -> Fourth + Send + Sync + 'static,
    ) -> Self {
        let whole = ("before every a_ijkl".to_owned(), 1.0);
        let form = move |numbers: &[f64], a: &Matrix3<f64>| Fourth(form(&numbers[1..], a).0 * numbers[0]);
        Self { numbers: std::iter::once(whole).chain(numbers).collect(), form: Arc::new(form) }
    }
}

/// A closure with the numbers in it.
pub fn numbered(closure: Closure) -> Numbered {
    let before = |term: &str| (format!("before {term}"), 1.0);
    let coefficients = |names: [&str; 3], terms: &[String], values: &[f64]| -> Vec<(String, f64)> {
        let name = |(k, value): (usize, &f64)| {
            let (name, term) = (names[k / terms.len()], &terms[k % terms.len()]);
            (
                if term.is_empty() { format!("as the constant of {name}") } else { format!("before {term} in {name}") },
                *value,
            )
        };
        values.iter().enumerate().map(name).collect()
    };
    let in_axes = |fit: &'static orthotropic::Fit| {
        let names = coefficients(["a_1111", "a_2222", "a_3333"], &terms(fit.powers, XY), &fit.coefficients);
        Numbered::new(names, |numbers, a| orthotropic::Fit { coefficients: numbers.to_vec(), ..fit.clone() }.fourth(a))
    };
    // Both brackets as a whole, then each term of theirs.
    let linear_terms = || {
        let brackets = [("before its terms with a_ij", 1.0 / 7.0), ("before its terms δ_ij δ_kl", -1.0 / 35.0)];
        let brackets = brackets.map(|(name, value)| (name.to_owned(), value));
        brackets.into_iter().chain(TERMS.map(|term| before(&format!("{term} of its linear part"))))
    };
    let linear = |numbers: &[f64], a: &Matrix3<f64>| {
        weighted(a, &std::array::from_fn(|k| numbers[2 + k]), 1.0 / numbers[0], -1.0 / numbers[1])
    };
    match closure {
        Closure::Linear => Numbered::new(linear_terms(), linear),
        Closure::Quadratic | Closure::Natural => Numbered::new([], move |_, a| closure.fourth(a)),
        Closure::Hybrid => {
            let determinant = OF_DETERMINANT.iter().map(|(name, ..)| (format!("before {name} in det a"), 1.0));
            let f = [("as the constant of f".to_owned(), 1.0), ("before det a in f".to_owned(), -27.0)];
            let all: Vec<_> = linear_terms().chain(f).chain(determinant).collect();
            Numbered::new(all, move |numbers, a| {
                let products = OF_DETERMINANT.iter().zip(&numbers[13..]);
                let determinant: f64 =
                    products.map(|((_, sign, at), n)| sign * n * at.map(|at| a[at]).iter().product::<f64>()).sum();
                mixed(a, numbers[11] + numbers[12] * determinant, |a| linear(numbers, a))
            })
        }
        Closure::Ore => in_axes(&orthotropic::ORE_FIT),
        Closure::Orw => in_axes(&orthotropic::ORW_FIT),
        Closure::Ibof => {
            let fit = &*ibof::FIT;
            let first = coefficients(["β3", "β4", "β6"], &terms(&fit.powers, INVARIANT), &fit.coefficients);
            let places = ["S(δ δ)", "S(δ a)", "S(a a)", "S(δ a·a)", "S(a a·a)", "S(a·a a·a)"];
            let related = ["β1", "β2", "β5"].into_iter().zip(&fit.relations).flat_map(|(name, relation)| {
                relation.iter().map(move |(of, powers, value)| {
                    let factors = [["", "β3", "β4", "β6"][*of], &terms(&[*powers], INVARIANT)[0]].join(" ");
                    let factors = factors.trim();
                    let term = if factors.is_empty() {
                        "as the constant of".to_owned()
                    } else {
                        format!("before {factors} in")
                    };
                    (format!("{term} {name}"), *value)
                })
            });
            let all: Vec<_> = first.into_iter().chain(places.map(before)).chain(related).collect();
            Numbered::new(all, move |numbers, a| {
                let mut fit = fit.clone();
                let (coefficients, numbers) = numbers.split_at(fit.coefficients.len());
                fit.coefficients.copy_from_slice(coefficients);
                let (weights, numbers) = numbers.split_at(fit.weights.len());
                fit.weights.copy_from_slice(weights);
                for ((.., value), number) in fit.relations.iter_mut().flatten().zip(numbers) {
                    *value = *number;
                }
                fit.fourth(a)
            })
        }
    }
}

/// A product of three components, with its name and the number before it.
type Product = (&'static str, f64, [(usize, usize); 3]);

/// The products of a determinant.
const OF_DETERMINANT: [Product; 5] = [
    ("a_11 a_22 a_33", 1.0, [(0, 0), (1, 1), (2, 2)]),
    ("2a_12 a_13 a_23", 2.0, [(0, 1), (0, 2), (1, 2)]),
    ("−a_11 a_23²", -1.0, [(0, 0), (1, 2), (1, 2)]),
    ("−a_22 a_13²", -1.0, [(1, 1), (0, 2), (0, 2)]),
    ("−a_33 a_12²", -1.0, [(2, 2), (0, 1), (0, 1)]),
];
