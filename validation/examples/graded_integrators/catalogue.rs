//! Every method that is graded, right, and with one coefficient wrong.

use shearbed_validation::methods::textbook::tableaus::{self, Tableau};
use shearbed_validation::methods::textbook::{Form, Method};

/// A method to be graded.
#[derive(Clone)]
pub struct Entry {
    /// Its name, and in a wrong one what is wrong.
    pub name: String,
    /// What it is one of, in the table.
    pub family: &'static str,
    pub method: Method,
    pub form: Form,
    /// The order that is claimed; none of an adaptive one.
    pub order: Option<u32>,
    pub right: bool,
}

fn named(name: &str) -> Tableau {
    tableaus::all().into_iter().find(|tableau| tableau.name == name).expect("a tableau of this name")
}

/// Name, method, order, and the forms that it is used in.
type Family = (String, Method, Option<u32>, &'static [Form]);

fn families() -> Vec<Family> {
    use Form::{Angles, Linear, Normalised, Raw};
    const EVERY: &[Form] = &[Raw, Normalised, Linear, Angles];
    const NOT_LINEAR: &[Form] = &[Raw, Normalised, Angles];
    let mut all: Vec<Family> = Vec::new();
    let mut add = |name: &str, method, order, forms| all.push((name.to_owned(), method, order, forms));
    for tableau in tableaus::all() {
        let (name, order) = (tableau.name, tableau.order);
        add(name, Method::RungeKutta(tableau), Some(order), EVERY);
    }
    let adams: [(u32, &[f64], &[&str]); 3] = [
        (2, &[1.5, -0.5], &["Euler", "Heun 2", "RK4"]),
        (3, &[23.0 / 12.0, -16.0 / 12.0, 5.0 / 12.0], &["Heun 2", "Kutta 3", "RK4"]),
        (4, &[55.0 / 24.0, -59.0 / 24.0, 37.0 / 24.0, -9.0 / 24.0], &["Kutta 3", "RK4", "Butcher 6"]),
    ];
    for (order, b, starters) in adams {
        for starter in starters {
            let method = Method::Adams { b: b.to_vec(), starter: named(starter) };
            add(&format!("AB{order} from {starter}"), method, Some(order), NOT_LINEAR);
        }
    }
    let method = Method::PredictorCorrector {
        b: vec![55.0 / 24.0, -59.0 / 24.0, 37.0 / 24.0, -9.0 / 24.0],
        moulton: vec![9.0 / 24.0, 19.0 / 24.0, -5.0 / 24.0, 1.0 / 24.0],
        starter: named("RK4"),
    };
    add("ABM4 from RK4", method, Some(4), NOT_LINEAR);
    let r = 3f64.sqrt();
    let s = 15f64.sqrt();
    type Implicit = (&'static str, u32, Vec<Vec<f64>>, Vec<f64>);
    let implicit: [Implicit; 6] = [
        ("implicit Euler", 1, vec![vec![1.0]], vec![1.0]),
        ("implicit midpoint", 2, vec![vec![0.5]], vec![1.0]),
        ("trapezoidal rule", 2, vec![vec![0.0, 0.0], vec![0.5, 0.5]], vec![0.5, 0.5]),
        ("Gauss 4", 4, vec![vec![0.25, 0.25 - r / 6.0], vec![0.25 + r / 6.0, 0.25]], vec![0.5, 0.5]),
        ("Radau IIA 3", 3, vec![vec![5.0 / 12.0, -1.0 / 12.0], vec![0.75, 0.25]], vec![0.75, 0.25]),
        (
            "Gauss 6",
            6,
            vec![
                vec![5.0 / 36.0, 2.0 / 9.0 - s / 15.0, 5.0 / 36.0 - s / 30.0],
                vec![5.0 / 36.0 + s / 24.0, 2.0 / 9.0, 5.0 / 36.0 - s / 24.0],
                vec![5.0 / 36.0 + s / 30.0, 2.0 / 9.0 + s / 15.0, 5.0 / 36.0],
            ],
            vec![5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0],
        ),
    ];
    for (name, order, a, b) in implicit {
        add(name, Method::Implicit { a, b }, Some(order), EVERY);
    }
    let suzuki = 1.0 / (4.0 - 4f64.powf(1.0 / 3.0));
    let parts = vec![suzuki, suzuki, 1.0 - 4.0 * suzuki, suzuki, suzuki];
    add("Suzuki 4 of implicit midpoint", Method::Composed(parts), Some(4), &[Raw, Normalised, Linear]);
    let lie_group: [(&str, bool, &[&str]); 2] = [
        ("Lie-group", false, &["Euler", "midpoint", "Heun 2", "Ralston 2"]),
        ("RKMK", true, &["Kutta 3", "Heun 3", "RK4", "Kutta 3/8", "Gill 4"]),
    ];
    for (kind, rkmk, names) in lie_group {
        for name in names {
            let tableau = named(name);
            let order = Some(tableau.order);
            add(&format!("{kind} {name}"), Method::LieGroup { tableau, rkmk }, order, &[Raw]);
        }
    }
    let yoshida = 1.0 / (2.0 - 2f64.powf(1.0 / 3.0));
    let middle = 1.0 - 2.0 * yoshida;
    let splittings: [(&str, u32, Vec<f64>, Vec<f64>); 3] = [
        ("Lie-Trotter splitting", 1, vec![1.0], vec![1.0]),
        ("Strang splitting", 2, vec![0.5, 0.5], vec![1.0]),
        (
            "Yoshida 4 splitting",
            4,
            vec![yoshida / 2.0, (yoshida + middle) / 2.0, (yoshida + middle) / 2.0, yoshida / 2.0],
            vec![yoshida, middle, yoshida],
        ),
    ];
    for (name, order, turning, stretching) in splittings {
        add(name, Method::Splitting { turning, stretching }, Some(order), &[Linear]);
    }
    for (tableau, other) in tableaus::pairs() {
        add(tableau.name, Method::Adaptive { tableau, other }, None, NOT_LINEAR);
    }
    add("Dormand-Prince 8(5,3)", Method::DormandPrince8, None, NOT_LINEAR);
    all
}

fn family(method: &Method, order: Option<u32>) -> &'static str {
    match (method, order) {
        (Method::RungeKutta(_), Some(1..=2)) => "Runge–Kutta, orders 1 and 2",
        (Method::RungeKutta(_), Some(3..=4)) => "Runge–Kutta, orders 3 and 4",
        (Method::RungeKutta(_), _) => "Runge–Kutta, orders 5 to 8",
        (Method::Adams { .. } | Method::PredictorCorrector { .. }, _) => "multistep, orders 2 to 4",
        (Method::Implicit { .. } | Method::Composed(_), _) => "implicit and symplectic, orders 1 to 6",
        (Method::LieGroup { .. }, _) => "Lie-group, orders 1 to 4",
        (Method::Splitting { .. }, _) => "splitting, orders 1 to 4",
        (Method::Adaptive { .. } | Method::DormandPrince8, _) => "adaptive, 3(2) to 8(5,3)",
    }
}

fn form_name(form: Form) -> &'static str {
    match form {
        Form::Raw => "in p",
        Form::Normalised => "in p, normalised",
        Form::Linear => "in q, normalised",
        Form::Angles => "in angles",
    }
}

/// Every method, the right ones first.
pub fn all() -> impl Iterator<Item = Entry> {
    right().into_iter().chain(wrong())
}

/// Every right method.
pub fn right() -> Vec<Entry> {
    let entries = families().into_iter().flat_map(|(name, method, order, forms)| {
        forms.iter().map(move |form| Entry {
            name: format!("{name} {}", form_name(*form)),
            family: family(&method, order),
            method: method.clone(),
            form: *form,
            order,
            right: true,
        })
    });
    entries.collect()
}

/// Every wrong one: of each method some of its coefficients, one at a time, times 0.9.
pub fn wrong() -> Vec<Entry> {
    let mut all = Vec::new();
    for entry in right() {
        let count = coefficients(&mut entry.method.clone()).len();
        // The first, the last, and one between: a long tableau has many that are alike.
        let mut chosen: Vec<usize> = if count == 0 { Vec::new() } else { vec![0, count / 2, count - 1] };
        chosen.dedup();
        for at in chosen {
            let mut method = entry.method.clone();
            *coefficients(&mut method)[at] *= 0.9;
            let name = format!("{}, coefficient {at} times 0.9", entry.name);
            if !still_right(&method, entry.form, entry.order) {
                all.push(Entry { name, method, right: false, ..entry.clone() });
            }
        }
    }
    all
}

/// Whether a method has its order for all that: a one-stage implicit method of order 1 has it with any a, and of a
/// linear equation the order is that of the polynomial 1 + Σ bᵀaᵏ⁻¹1 zᵏ, which must be eᶻ up to zᵖ.
fn still_right(method: &Method, form: Form, order: Option<u32>) -> bool {
    match (method, order) {
        (Method::Implicit { a, b }, Some(1)) => a.len() == 1 && b[0] == 1.0,
        (Method::RungeKutta(tableau), Some(order)) if form == Form::Linear => {
            let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
            let mut stages = vec![1.0; tableau.b.len()];
            let mut due = 1.0;
            (1..=order).all(|k| {
                due /= f64::from(k);
                let found = dot(&tableau.b, &stages);
                stages = tableau.a.iter().map(|row| dot(row, &stages)).collect();
                (found / due - 1.0).abs() < 1e-9
            })
        }
        _ => false,
    }
}

/// The coefficients that are not 0 and that the answer depends on.
fn coefficients(method: &mut Method) -> Vec<&mut f64> {
    let all: Vec<&mut Vec<f64>> = match method {
        Method::RungeKutta(tableau) | Method::LieGroup { tableau, .. } => {
            tableau.a.iter_mut().chain([&mut tableau.b]).collect()
        }
        Method::Implicit { a, b } => a.iter_mut().chain([b]).collect(),
        Method::Splitting { turning, stretching } => vec![turning, stretching],
        Method::Adams { b: own, .. } | Method::PredictorCorrector { moulton: own, .. } | Method::Composed(own) => {
            vec![own]
        }
        // The step control sees a wrong stage and takes shorter steps: its answers stay right. The weights it does not.
        Method::Adaptive { tableau, .. } => vec![&mut tableau.b],
        // Its coefficients are its library's.
        Method::DormandPrince8 => Vec::new(),
    };
    all.into_iter().flatten().filter(|x| **x != 0.0).collect()
}
