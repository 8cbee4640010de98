//! Programs that solve da/dt of Folgar & Tucker with the quadratic closure: by equal steps that must end at every time
//! asked for, by a tolerance alone, and in axes of their own.

use serde_json::{Value, json};
use shearbed::nalgebra::Matrix3;
use shearbed_validation::methods::integrators::rk4;

type M = Matrix3<f64>;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn matrix(value: &Value) -> M {
    M::from_fn(|i, j| number(&value[i][j]))
}

/// The table that is asked for, or the program's own error.
pub fn answer(name: &str, request: &Value) -> Value {
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
            a = rk4(rate, a, h);
            taken += 1.0;
        }
        rows.push([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|place| a[place]));
    }
    json!({"id": id, "rows": rows})
}
