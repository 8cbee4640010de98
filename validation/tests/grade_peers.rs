//! Programs that nobody here wrote, and small ones in other languages, graded as a user would; and copies of the NumPy code
//! with one planted mistake each, which must be named. What cannot run here is skipped by name and reason in one line, and
//! recorded answers (`validation/peers/recorded`) are graded in its place.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use tempfile::TempDir;

static REFERENCE: LazyLock<TempDir> = LazyLock::new(|| {
    let dir = tempfile::tempdir().unwrap();
    let mut export = Command::new(env!("CARGO_BIN_EXE_shearbed"));
    assert!(
        export
            .args(["problems", "export", "--force"])
            .arg(dir.path())
            .status()
            .unwrap()
            .success()
    );
    dir
});

fn peers() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("peers")
}

/// A Python that can import a module: of `.ci/run`'s virtual environment, or the machine's.
fn python(module: &str) -> Option<String> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/peers-venv/bin/python");
    let candidates = [own.to_string_lossy().into_owned(), "python3".to_owned()];
    let can = |python: &String| runs(python, &["-c", &format!("import {module}")]);
    candidates.into_iter().find(can)
}

fn runs(program: &str, arguments: &[&str]) -> bool {
    let quiet = Command::new(program)
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    quiet.is_ok_and(|status| status.success())
}

fn run(program: &str, arguments: &[&Path]) {
    let output = Command::new(program).args(arguments).output().unwrap();
    assert!(
        output.status.success(),
        "{program} {arguments:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
}

struct Graded {
    code: Option<i32>,
    words: String,
    grade: Value,
}

fn graded(arguments: &[&str]) -> Graded {
    let out = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(["grade", "--out"])
        .arg(out.path())
        .args(arguments)
        .output()
        .unwrap();
    let words = [output.stdout, output.stderr]
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .concat();
    let text = fs::read_to_string(out.path().join("grade.json"));
    Graded {
        code: output.status.code(),
        grade: serde_json::from_str(&text.unwrap_or_else(|_| panic!("{words}"))).unwrap(),
        words,
    }
}

fn files(mine: &Path) -> Graded {
    graded(&[REFERENCE.path().to_str().unwrap(), mine.to_str().unwrap()])
}

impl Graded {
    fn of(&self, name: &str) -> &Value {
        let all = self.grade["problems"].as_array().unwrap();
        all.iter()
            .find(|graded| graded["name"] == name)
            .unwrap_or_else(|| panic!("{name}: {}", self.words))
    }

    fn verdict(&self, name: &str) -> &str {
        self.of(name)["verdict"].as_str().unwrap()
    }

    fn order(&self, name: &str) -> f64 {
        self.of(name)["observed_order"].as_f64().unwrap_or(f64::NAN)
    }
}

/// Some of the exported problems in a folder of their own.
fn some(to: &Path, names: &[&str]) -> PathBuf {
    for name in names {
        fs::create_dir_all(to.join(name)).unwrap();
        for entry in fs::read_dir(REFERENCE.path().join(name)).unwrap() {
            let from = entry.unwrap().path();
            fs::copy(&from, to.join(name).join(from.file_name().unwrap())).unwrap();
        }
    }
    to.to_owned()
}

fn skipped(name: &str, reason: &str) {
    println!("skipped: {name}, {reason}");
}

#[test]
fn numpy_rk4_passes_with_order_4_and_euler_fails_with_order_1() {
    let script = peers().join("numpy_rk4.py");
    let dir = tempfile::tempdir().unwrap();
    let mine = match python("numpy") {
        Some(python) => {
            run(&python, &[&script, REFERENCE.path(), dir.path()]);
            dir.path().to_owned()
        }
        None => {
            skipped("numpy_rk4.py", "no python3 with numpy");
            peers().join("recorded/numpy_rk4")
        }
    };
    let rk4 = files(&mine);
    assert_eq!(rk4.code, Some(0), "{}", rk4.words);
    for name in ["mid-flip-2", "mid-flip-11.6", "isotropic-11.6"] {
        assert_eq!(rk4.verdict(name), "PASS", "{}", rk4.words);
        assert!((rk4.order(name) - 4.0).abs() < 0.2, "{name}: {}", rk4.words);
    }
    let Some(python) = python("numpy") else { return };
    for name in [
        "contact-rule",
        "contact-angles",
        "unequal-rods",
        "ten-thousand-periods",
        "mid-flip-10000",
    ] {
        assert_eq!(rk4.verdict(name), "PASS", "{}", rk4.words);
    }
    let mine = dir.path().join("euler");
    run(&python, &[&script, REFERENCE.path(), &mine, Path::new("--euler")]);
    let euler = files(&mine);
    assert_eq!(euler.code, Some(1));
    for name in [
        "mid-flip-2",
        "mid-flip-11.6",
        "sphere",
        "spiral",
        "uniaxial-extension",
        "couette-turned",
    ] {
        assert_eq!(euler.verdict(name), "FAIL", "{}", euler.words);
        assert!((euler.order(name) - 1.0).abs() < 0.2, "{name}: {}", euler.words);
        assert_eq!(
            euler.of(name)["diagnosis"],
            Value::Null,
            "Euler's is no known mistake: {}",
            euler.words
        );
    }
    // It steps over every flip of a fibre.
    for name in ["mid-flip-10000", "ten-thousand-periods"] {
        assert_eq!(euler.verdict(name), "FAIL");
    }
    let live = format!("'{python}' '{}' --live", script.display());
    let live = graded(&["--command", &live, "--brief", "--order", "4", "--timeout", "60"]);
    assert_eq!(live.code, Some(0), "{}", live.words);
}

/// A line of the NumPy code, what it is replaced by, the problem that shows it, and the name it must get.
const PLANTED: &[(&str, &str, &str, &str)] = &[
    (
        "(r_e**2 * L - L.T)",
        "(r_e**2 * L.T - L)",
        "mid-flip-11.6",
        "a transposed gradient",
    ),
    (
        "    L = np.array(gradient, dtype=float)\n",
        "    L, r_e = np.array(gradient, dtype=float), max(r_e, 1 / r_e)\n",
        "disc-0.1",
        "Λ without its sign",
    ),
    (
        "(r_e**2 * L - L.T) / (r_e**2 + 1)",
        "L",
        "mid-flip-11.6",
        "no 1/r_e",
    ),
    (
        "return q / np",
        "q[:, [0, 1]] = q[:, [1, 0]]\n    return q / np",
        "mid-flip-11.6",
        "p_1 and p_2 exchanged",
    ),
    (
        "    q = start @",
        "    phi, theta = np.degrees(np.arctan2(start[:, 1], start[:, 0])), np.degrees(np.arccos(start[:, 2]))\n    start = np.column_stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])\n    q = start @",
        "mid-flip-11.6",
        "degrees for radians in the start",
    ),
    (
        "np.array(gradient, dtype=float)",
        "0.5 * np.array(gradient, dtype=float)",
        "mid-flip-11.6",
        "half the shear rate",
    ),
    (
        "    A, start =",
        "    r_e = 1.24 * r_e / math.sqrt(math.log(max(r_e, 2)))\n    A, start =",
        "mid-flip-11.6",
        "r_p for r_e (r_e taken as r_p of Cox 1971)",
    ),
    (
        "    A, start =",
        "    time *= (r_e + 1 / r_e) / r_e\n    A, start =",
        "mid-flip-2",
        "T without 1/r_e",
    ),
    (
        "return q / np",
        "q[:, 2] *= -1\n    return q / np",
        "mid-flip-11.6",
        "axis 3 reversed (a left-handed frame)",
    ),
    (
        "return q / np.linalg.norm(q, axis=1, keepdims=True)",
        "return q",
        "mid-flip-11.6",
        "p that is not normalised",
    ),
    (
        "line * ((mean - v) / s)",
        "line * ((v - mean) / s)",
        "contact-rule",
        "a kick with the wrong sign",
    ),
    (") / math.sin(theta)\n", ")\n", "contact-angles", ""),
    (
        "/ math.sin(theta)\n    theta_rate = (rate[0] * math.cos(phi) + rate[1] * math.sin(phi)) * math.cos(theta) - rate[2] * math.sin(theta)",
        "\n    theta_rate = (rate[0] * math.cos(phi) + rate[1] * math.sin(phi)) * math.sin(theta) - rate[2] * math.cos(theta)",
        "contact-angles",
        "A.13 as printed",
    ),
];

#[test]
fn each_planted_mistake_gets_its_own_name_and_the_unspoilt_code_none() {
    let Some(python) = python("numpy") else {
        return skipped("planted mistakes in numpy_rk4.py", "no python3 with numpy");
    };
    let dir = tempfile::tempdir().unwrap();
    let code = fs::read_to_string(peers().join("numpy_rk4.py")).unwrap();
    // Rods, tensors and contacts that show the mistakes, and no more.
    let reference = some(
        &dir.path().join("ref"),
        &[
            "mid-flip-2",
            "mid-flip-11.6",
            "disc-0.1",
            "isotropic-3",
            "contact-rule",
            "contact-angles",
        ],
    );
    let judge = |code: &str, name: &str| {
        let (script, mine) = (dir.path().join(format!("{name}.py")), dir.path().join(name));
        fs::write(&script, code).unwrap();
        run(&python, &[&script, &reference, &mine]);
        graded(&[reference.to_str().unwrap(), mine.to_str().unwrap()])
    };
    let unspoilt = judge(&code, "unspoilt");
    assert_eq!(unspoilt.code, Some(0), "{}", unspoilt.words);
    for found in unspoilt.grade["problems"].as_array().unwrap() {
        assert_eq!(found["diagnosis"], Value::Null);
    }
    for (k, (line, mistake, shows, expected)) in PLANTED.iter().enumerate() {
        assert!(code.contains(line), "{line}");
        let spoilt = judge(&code.replace(line, mistake), &format!("spoilt-{k}"));
        let found = spoilt.of(shows);
        assert_eq!(
            (spoilt.code, &found["verdict"]),
            (Some(1), &"FAIL".into()),
            "{mistake}: {}",
            spoilt.words
        );
        let diagnosis = found["diagnosis"].as_str().unwrap_or_default();
        assert!(
            diagnosis.contains(expected),
            "{mistake}: {diagnosis:?} for {expected}: {}",
            spoilt.words
        );
        // Half of the printed A.13 is a mistake that nobody has named.
        assert_eq!(
            diagnosis.is_empty(),
            expected.is_empty(),
            "{mistake}: {diagnosis}"
        );
        assert!(!diagnosis.contains(" or of "), "{mistake}: {diagnosis}");
    }
    // The means of isotropic rods show the mistakes of the flow too.
    let spoilt = judge(
        &code.replace(
            "np.array(gradient, dtype=float)",
            "0.5 * np.array(gradient, dtype=float)",
        ),
        "tensor",
    );
    let diagnosis = spoilt.of("isotropic-3")["diagnosis"].as_str().unwrap_or_default();
    assert!(diagnosis.contains("half the shear rate"), "{}", spoilt.words);
}

#[test]
fn c_compiled_with_cc_passes_with_order_4() {
    if !runs("cc", &["--version"]) {
        return skipped("c_rk4.c", "no cc");
    }
    let dir = tempfile::tempdir().unwrap();
    let program = dir.path().join("c_rk4");
    run(
        "cc",
        &[
            Path::new("-O2"),
            Path::new("-o"),
            &program,
            &peers().join("c_rk4.c"),
            Path::new("-lm"),
        ],
    );
    let command = format!("'{}'", program.display());
    let found = graded(&["--command", &command, "--order", "4", "--timeout", "60"]);
    assert_eq!(found.code, Some(0), "{}", found.words);
    assert!((found.order("mid-flip-11.6") - 4.0).abs() < 0.2);
    let live = &found.grade["live"];
    assert!(
        live["work_precision"]["pipe_s"]
            .as_f64()
            .is_some_and(|seconds| seconds > 0.0),
        "{}",
        found.words
    );
    // As the project's own RK4 in p: the longest step with which every rod of r_e = 11.6 turns.
    let limits = live["limits"].as_array().unwrap();
    let turning = limits
        .iter()
        .find(|limit| limit["property"] == "turning" && limit["aspect_ratio"] == 11.6)
        .unwrap();
    let own = own_turning_limit();
    assert!(
        (turning["strain"]["at"].as_f64().unwrap() / own - 1.0).abs() < 1e-3,
        "{turning} {own}"
    );
}

/// Of the subject `RK4 in p`, by the same ladder.
fn own_turning_limit() -> f64 {
    use validation::stability::limits::{Ladder, Limit, Property, bisect, holds};
    let subjects = validation::subject::all();
    let rk4 = subjects
        .iter()
        .find(|subject| subject.name() == "RK4 in p")
        .unwrap();
    let ladder = Ladder {
        least: 0.01,
        most: 100.0,
        factor: 1.25,
    };
    match bisect(ladder, |strain| {
        holds(rk4.as_ref(), Property::Turning, 11.6, strain)
    }) {
        Limit::At(strain) => strain,
        other => panic!("{other:?}"),
    }
}

#[test]
fn javascript_has_order_2() {
    if !runs("node", &["--version"]) {
        return skipped("midpoint.js", "no node");
    }
    let script = peers().join("midpoint.js");
    let command = format!("node '{}'", script.display());
    let of = [
        "--problem",
        "mid-flip-2",
        "--problem",
        "mid-flip-11.6",
        "--problem",
        "spiral",
    ];
    let found = graded(
        &[
            &[
                "--command",
                &command,
                "--brief",
                "--order",
                "2",
                "--timeout",
                "20",
            ][..],
            &of,
        ]
        .concat(),
    );
    for name in ["mid-flip-2", "mid-flip-11.6", "spiral"] {
        assert!((found.order(name) - 2.0).abs() < 0.2, "{name}: {}", found.words);
        assert!(found.of(name)["length_drift"].as_f64().unwrap() < 1e-14);
    }
    let dir = tempfile::tempdir().unwrap();
    run("node", &[&script, REFERENCE.path(), dir.path()]);
    let found = files(dir.path());
    assert_eq!(
        (found.verdict("log-rolling"), found.verdict("mid-flip-10000")),
        ("PASS", "FAIL"),
        "{}",
        found.words
    );
}

/// fiberoripy 1.4.0 with SciPy's DOP853 at 10⁻¹² and its closures.
fn judge_fiberoripy(found: &Graded) {
    assert_eq!(found.code, Some(1));
    for name in ["mid-flip-2", "mid-flip-11.6"] {
        assert_eq!(found.verdict(name), "PASS", "{}", found.words);
    }
    // It claims success and has lost the fibre.
    let fibre = found.of("mid-flip-10000");
    assert!(
        fibre["verdict"] == "FAIL" && fibre["error"].as_f64().unwrap() > 0.01,
        "{fibre:#}"
    );
    for (name, error) in CLOSURES {
        let of = found.of(name);
        assert_eq!(of["verdict"], "FAIL");
        assert!(
            (of["error"].as_f64().unwrap() / error - 1.0).abs() < 0.01,
            "{name} {error}: {of:#}"
        );
        assert_eq!(of["diagnosis"], Value::Null);
    }
}

/// By how much the IBOF closure misses a_ij of isotropic rods: recorded from fiberoripy 1.4.0, to a percent.
const CLOSURES: [(&str, f64); 2] = [("isotropic-3", 0.01503), ("isotropic-11.6", 0.09602)];

#[test]
fn fiberoripy_is_right_until_rods_are_fibres_and_its_closure_is_no_solution() {
    judge_fiberoripy(&files(&peers().join("recorded/fiberoripy-1.4.0")));
    let Some(python) = python("fiberoripy") else {
        return skipped(
            "fiberoripy",
            "no python3 with fiberoripy: only its recorded answers were graded",
        );
    };
    let script = peers().join("fiberoripy_peer.py");
    let dir = tempfile::tempdir().unwrap();
    // It needs minutes for the others.
    let names = [
        "mid-flip-2",
        "mid-flip-11.6",
        "mid-flip-10000",
        "isotropic-3",
        "isotropic-11.6",
    ];
    let reference = some(&dir.path().join("ref"), &names);
    let mine = dir.path().join("mine");
    run(&python, &[&script, &reference, &mine]);
    judge_fiberoripy(&files(&mine));
    let command = format!("'{python}' '{}' --live", script.display());
    let of = ["--problem", "mid-flip-2", "--problem", "mid-flip-10000"];
    let live = graded(&[&["--command", &command, "--brief", "--timeout", "60"][..], &of].concat());
    assert_eq!(live.verdict("mid-flip-2"), "PASS", "{}", live.words);
    assert_eq!(live.verdict("mid-flip-10000"), "FAIL", "{}", live.words);
    let note = live.of("mid-flip-10000")["note"].as_str().unwrap();
    assert!(note.starts_with("it claims success"), "{note}");
}

#[test]
fn layouts_of_other_programs_are_read_as_they_are() {
    let layouts = peers().join("layouts");
    for (sample, problem, more, verdict) in [
        ("fiberoripy.csv", "isotropic-3", &[][..], "FAIL"),
        ("fiberpy.csv", "isotropic-3", &["--layout", "fiberpy"], "FAIL"),
        ("openfoam.csv", "isotropic-3", &[], "PASS"),
        ("lammps.dump", "shear-plane", &[], "PASS"),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let ending = sample.split('.').next_back().unwrap();
        fs::create_dir(dir.path().join(problem)).unwrap();
        fs::copy(
            layouts.join(sample),
            dir.path().join(problem).join(format!("answer.{ending}")),
        )
        .unwrap();
        let told = [REFERENCE.path().to_str().unwrap(), dir.path().to_str().unwrap()];
        let found = graded(&[&told[..], more].concat());
        assert_eq!(found.verdict(problem), verdict, "{sample}: {}", found.words);
        // A closure is near the truth; columns in a wrong order are not.
        assert!(
            found.of(problem)["error"].as_f64().unwrap() < 0.05,
            "{sample}: {}",
            found.words
        );
    }
}

/// The blocks of `docs/grading.md` in a language.
fn blocks(language: &str) -> Vec<String> {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/grading.md")).unwrap();
    let parts = page.split("```").skip(1).step_by(2);
    parts
        .filter_map(|block| block.strip_prefix(&format!("{language}\n")))
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_quick_start_runs_as_it_is_written() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("my_code.py"), &blocks("python")[0]).unwrap();
    fs::write(dir.path().join("my_code.cpp"), &blocks("cpp")[0]).unwrap();
    let own = Path::new(env!("CARGO_BIN_EXE_shearbed")).parent().unwrap();
    let path = format!("{}:{}", own.display(), std::env::var("PATH").unwrap());
    let commands = blocks("sh");
    assert_eq!(commands.len(), 3);
    for (needs, commands) in ["python3", "c++", "awk"].into_iter().zip(commands) {
        // awk has no --version everywhere.
        let there = if needs == "awk" {
            runs("awk", &["BEGIN {}"])
        } else {
            runs(needs, &["--version"])
        };
        if !there {
            skipped("quick start", &format!("no {needs}"));
            continue;
        }
        let mut shell = Command::new("sh");
        let output = shell
            .args(["-ec", &commands])
            .env("PATH", &path)
            .current_dir(dir.path())
            .output()
            .unwrap();
        let words =
            String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success() && words.contains("PASS"),
            "{needs}: {words}"
        );
    }
}
