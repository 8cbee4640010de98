//! Programs that behave, and programs that do not.

use crate::tensors;
use serde_json::{Value, json};
use shearbed::nalgebra::{Matrix3, Vector3};
use shearbed_validation::methods::integrators::Setting;
use shearbed_validation::methods::textbook::tableaus::extrapolated_euler;
use shearbed_validation::methods::textbook::{Form, Method, Turning, advance, rate_matrix, rk4_in_p};
use std::fs;
use std::io::{BufRead, Write};
use std::process::{Command, ExitCode, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

/// Acts as a program that is to be graded. Where its name does not say when, it does what that says from its third
/// answer on.
pub fn program(name: &str, pids: Option<&str>) -> ExitCode {
    let note = |pid: u32| {
        let file = fs::OpenOptions::new().create(true).append(true).open(pids.unwrap());
        writeln!(file.unwrap(), "{pid}").unwrap();
    };
    note(std::process::id());
    let forever = || -> ! {
        loop {
            std::thread::sleep(Duration::from_secs(1000));
        }
    };
    match name {
        "never_reads" => forever(),
        #[cfg(target_os = "linux")]
        "hangs_in_the_group_of_shearbed" => {
            use rustix::process::{getpgid, getppid, setpgid};
            setpgid(None, getppid().and_then(|parent| getpgid(Some(parent)).ok())).unwrap();
            forever();
        }
        #[cfg(target_os = "linux")]
        "hangs_with_daemons" => {
            for session in
                ["setsid sleep 1000 >/dev/null &", "trap '' TERM HUP; env -i setsid sh -c 'sleep 1000; :' >/dev/null &"]
            {
                let script = format!("exec 2>/dev/null; {session} echo $!");
                let daemon = Command::new("sh").args(["-c", &script]).output().unwrap().stdout;
                note(String::from_utf8(daemon).unwrap().trim().parse().unwrap());
            }
            forever();
        }
        #[cfg(target_os = "linux")]
        "leaves_a_daemon" => {
            let daemon = Command::new("sh").args(["-c", "setsid sleep 1000 >/dev/null 2>&1 & echo $!"]).output();
            note(String::from_utf8(daemon.unwrap().stdout).unwrap().trim().parse().unwrap());
        }
        _ => {}
    }
    let mut out = std::io::stdout();
    let mut before = json!([]);
    for (k, line) in std::io::stdin().lock().lines().enumerate() {
        let request: Value = serde_json::from_str(&line.unwrap()).unwrap();
        let mut answer = match request.get("tensor") {
            Some(_) => tensors::answer(name, &request),
            None => answer(name, &request, k as u64 + 1),
        };
        if name == "turns_one_question_late" {
            let own = answer["p"].clone();
            let before = std::mem::replace(&mut before, own);
            if before.as_array().unwrap().len() == answer["p"].as_array().unwrap().len() {
                answer["p"] = before;
            }
        }
        let mut text = answer.to_string();
        match (name, k) {
            ("is_right_on_one_line_of_stderr_each", _) => eprintln!("working"),
            ("floods_stderr", 2) => (0..20_000).for_each(|_| eprintln!("{}", "x".repeat(1000))),
            ("hangs", 2) => forever(),
            ("hangs_at_once", _) => forever(),
            ("hangs_with_a_child", _) => {
                let child = Command::new("sleep").arg("1000").stderr(Stdio::null()).spawn();
                note(child.unwrap().id());
                forever();
            }
            ("ends", 2) => {
                eprintln!("out of ideas");
                return ExitCode::from(3);
            }
            ("ends_after_a_right_answer", 2) => return ExitCode::from(4),
            ("aborts", 2) => std::process::abort(),
            ("prints_junk", 2) => text = format!("step 1 of 10\n{text}"),
            ("floods_stdout_with_lines", 1) => while writeln!(out, "flood").is_ok() {},
            ("floods_stdout_without_lines", 2) => while write!(out, "flood").is_ok() {},
            ("answers_twice", 0) => text = format!("{text}\n{text}"),
            ("answers_the_next_in_advance", 2) => {
                // Both lines at once: which of them is read when is the system's to say.
                let mut next = answer.clone();
                next["id"] = json!(request["id"].as_u64().unwrap() + 1);
                text = format!("{text}\n{next}");
            }
            ("has_an_id_twice", 2) => text = text.replacen('{', "{\"id\":0,", 1),
            #[cfg(unix)]
            ("closes_its_output", 2) => {
                // Another program in its place, without the pipe.
                use std::os::unix::process::CommandExt;
                let error = Command::new("sleep").arg("1000").stdout(Stdio::null()).exec();
                panic!("{error}");
            }
            _ => {}
        }
        if out.write_all((text + "\n").as_bytes()).and_then(|()| out.flush()).is_err() {
            return ExitCode::FAILURE;
        }
    }
    match name {
        "stays" => forever(),
        "says_more_at_the_end" => println!("bye"),
        _ => {}
    }
    ExitCode::SUCCESS
}

/// The answer to the `count`-th request.
fn answer(name: &str, request: &Value, count: u64) -> Value {
    let id = request["id"].as_u64().unwrap();
    if name == "only_has_errors" {
        return json!({"id": id, "error": "not today"});
    }
    let number = |value: &Value| value.as_f64().unwrap();
    let mut l = Matrix3::from_fn(|i, j| number(&request["gradient_per_s"][i][j]));
    if name == "transposes" {
        l.transpose_mut();
    }
    // Shear of its own first axis, and nothing else.
    if name == "flows_along_1" {
        l = Matrix3::from_fn(|i, j| if (i, j) == (0, 1) { l[(i, j)] } else { 0.0 });
    }
    let (ratio, rows) = (number(&request["aspect_ratio"]), l.transpose().into());
    let finer = if name == "ends_after_a_right_answer" { 1024 } else { 1 };
    let steps = finer * request["steps"].as_u64().unwrap();
    let end_s = number(&request["end_s"]);
    let rotation = request.get("rotation_rad_per_s").filter(|_| name.starts_with("turns"));
    let rotation = rotation.map(|rotation| Vector3::from_fn(|i, _| number(&rotation[i])));
    static FIRST_S: OnceLock<f64> = OnceLock::new();
    let always = name == "turns_for_the_same_time" && rotation.is_some();
    let h = if always { *FIRST_S.get_or_init(|| end_s) } else { end_s } / steps as f64;
    let steps = if name == "cuts_its_steps" { (end_s / h) as u64 } else { steps };
    let moved = |p: Vector3<f64>| match (rotation, method(name)) {
        (Some(rotation), _) => turning(name, l, rotation, ratio).rk4(p, h, steps),
        (None, Some((order, form))) => {
            let method = Method::RungeKutta(extrapolated_euler("", order));
            advance(&method, form, &rows, ratio, &p.into(), end_s, Setting::Steps(steps)).unwrap().into()
        }
        (None, None) => rk4_in_p(&rate_matrix(&rows, ratio), p, h, steps),
    };
    let rods = request["start"].as_array().unwrap();
    let mut p: Vec<_> = (rods.iter())
        .map(|p| moved(Vector3::from_fn(|i, _| number(&p[i]))))
        .map(|p| if name == "is_off_by_1e-8" { off_by_1e_8(p) } else { p })
        .map(|p| json!([p.x, p.y, p.z]))
        .collect();
    match name {
        "is_garbage_every_third_time" if count.is_multiple_of(3) => p.fill(json!([0.6, 0.0, 0.8])),
        "is_garbage_below_256_steps" if steps < 256 => p.fill(json!([0.6, 0.0, 0.8])),
        "is_random_within_the_tolerance" => p[0][0] = json!(number(&p[0][0]) + 1e-11 * (count % 5) as f64),
        "answers_nan" if count > 2 => p[0][0] = Value::Null,
        "forgets_a_rod" if count > 2 => drop(p.pop()),
        "answers_out_of_order" if count == 3 => return json!({"id": id - 1, "p": p}),
        _ => {}
    }
    json!({"id": id, "p": p})
}

/// The gradient L(t) = Q L Qᵀ + S with S p = ω × p, formed and taken as the name says.
fn turning(name: &str, l: Matrix3<f64>, rotation: Vector3<f64>, ratio: f64) -> Turning {
    let factors = match name {
        "turns_without_spin" => [1.0, 0.0],
        "turns_back" => [-1.0, -1.0],
        "turns_with_the_spin_reversed" => [1.0, -1.0],
        _ => [1.0, 1.0],
    };
    let when: fn(f64, f64) -> f64 = match name {
        "turns_by_steps" => |_, begun| begun,
        "turns_at_first" => |_, _| 0.0,
        _ => |time, _| time,
    };
    Turning { l, rotation, ratio, factors, when }
}

/// The order of a Runge–Kutta method by its name, `rk_P` or `rk_P_normalised`, and whether it takes |p| back to 1.
fn method(name: &str) -> Option<(usize, Form)> {
    let rest = name.strip_prefix("rk_")?;
    let (order, form) = rest.strip_suffix("_normalised").map_or((rest, Form::Raw), |order| (order, Form::Normalised));
    Some((order.parse().ok()?, form))
}

/// Turned by 10⁻⁸ rad.
fn off_by_1e_8(p: Vector3<f64>) -> Vector3<f64> {
    let across = p.cross(&Vector3::z()).normalize();
    p + across * 1e-8
}
