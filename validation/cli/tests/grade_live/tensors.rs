//! Programs that solve da/dt of Folgar & Tucker with the quadratic closure: by equal steps that must end at every time
//! asked for, by a tolerance alone, and in axes of their own; and one with random numbers.

use serde_json::{Value, json};
use shearbed::nalgebra::Matrix3;
use shearbed_validation::methods::integrators::rk4;
use shearbed_validation::methods::tensors::fourth::PAIRS;

type M = Matrix3<f64>;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn matrix(value: &Value) -> M {
    M::from_fn(|i, j| number(&value[i][j]))
}

/// Means of a Monte Carlo code for rods at rest that diffuse: a − 1/3 fades as e^{−6D_r t}, with errors of `scatter`.
fn at_rest(name: &str, request: &Value) -> Value {
    let factor = if name == "tensors_random_slow" { 0.5 } else { 1.0 };
    let scatter = if name == "tensors_random_few" { 0.01 } else { 1e-3 };
    let d_r = factor * number(&request["d_r_per_s"]);
    let start = matrix(&request["start"]);
    let mut random = request["id"].as_u64().unwrap();
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 40) as f64 / (1u64 << 24) as f64 - 0.5
    };
    // The sum of twelve has the variance 1.
    let mut gauss = || (0..12).map(|_| next()).sum::<f64>();
    let row = |time: &Value| {
        let fades = (-6.0 * d_r * number(time)).exp();
        PAIRS.map(|place| {
            let random = M::identity()[place] / 3.0;
            random + (start[place] - random) * fades + scatter * gauss()
        })
    };
    let rows: Vec<_> = request["times_s"].as_array().unwrap().iter().map(row).collect();
    json!({"id": request["id"], "rows": rows, "rows_se": vec![[scatter; 6]; rows.len()]})
}

/// The table that is asked for, or the program's own error.
pub fn answer(name: &str, request: &Value) -> Value {
    if name.starts_with("tensors_random") {
        return at_rest(name, request);
    }
    let id = &request["id"];
    let refused = |words: &str| json!({"id": id, "error": words});
    let times: Vec<_> = request["times_s"].as_array().unwrap().iter().map(number).collect();
    let steps = match (name, request["steps"].as_u64()) {
        // Twenty reach every time.
        ("tensors_by_tolerance", None) => 20.0 * (2.0 * number(&request["tolerance"]).powf(-0.25)).ceil(),
        ("tensors_by_tolerance", Some(_)) => return refused("I choose my steps"),
        (_, Some(steps)) => steps as f64,
        (_, None) => return refused("I take steps"),
    };
    let h = times[times.len() - 1] / steps;
    // The first axis is the flow.
    let flow = if name == "tensors_flow_along_1" { [0, 1] } else { [1, 0] };
    let g = request["gradient_per_s"][flow[0]][flow[1]].as_f64().unwrap();
    let mut l = M::zeros();
    l[(flow[0], flow[1])] = g;
    let c_i = number(&request["tensor"]["model"]["folgar-tucker"]["c_i"]);
    let rate = |a: M| {
        let d = 0.5 * (l + l.transpose());
        l * a + a * l.transpose() - 2.0 * a.dot(&d) * a + 2.0 * c_i * g.abs() * (M::identity() - 3.0 * a)
    };
    let (mut a, mut taken) = (matrix(&request["start"]), 0.0);
    let mut rows = Vec::new();
    for time in times {
        // As near as equal steps come.
        while taken < (time / h).round() {
            taken += 1.0;
            if name == "tensors_lose_an_odd_step" && steps % 2.0 == 1.0 && taken == steps {
                break;
            }
            a = rk4(rate, a, h);
        }
        rows.push(PAIRS.map(|place| a[place]));
    }
    json!({"id": id, "rows": rows})
}
