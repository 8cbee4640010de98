//! Copies of the NumPy code with one planted mistake each, which must be named.

use crate::grading::{files, some};
use crate::programs::{peers, python, run, skipped};
use rayon::prelude::*;
use serde_json::Value;
use std::fs;

/// A line of the NumPy code, what it is replaced by, the problem that shows it, and the name it must get.
const PLANTED: &[(&str, &str, &str, &str)] = &[
    ("(r_e**2 * L - L.T)", "(r_e**2 * L.T - L)", "mid-flip-11.6", "a transposed gradient"),
    (
        "    L = np.array(gradient, dtype=float)\n",
        "    L, r_e = np.array(gradient, dtype=float), max(r_e, 1 / r_e)\n",
        "disc-0.1",
        "Λ without its sign or of Λ with the wrong sign (1/r_e for r_e)",
    ),
    ("(r_e**2 * L - L.T) / (r_e**2 + 1)", "L", "mid-flip-11.6", "no 1/r_e"),
    ("return q / np", "q[:, [0, 1]] = q[:, [1, 0]]\n    return q / np", "mid-flip-11.6", "p_1 and p_2 exchanged"),
    (
        "    q = start @",
        "    phi, theta = np.degrees(np.arctan2(start[:, 1], start[:, 0])), np.degrees(np.arccos(start[:, 2]))\n    \
         start = np.column_stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])\n    q = \
         start @",
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
        "    L = np.array(gradient, dtype=float)",
        "    L = -np.array(gradient, dtype=float)",
        "mid-flip-11.6",
        "the flow reversed (L with the wrong sign, or time backwards)",
    ),
    ("    A, start =", "    time *= (r_e + 1 / r_e) / r_e\n    A, start =", "mid-flip-2", "T without 1/r_e"),
    ("return q / np", "q[:, 2] *= -1\n    return q / np", "mid-flip-11.6", "axis 3 reversed (a left-handed frame)"),
    ("return q / np.linalg.norm(q, axis=1, keepdims=True)", "return q", "mid-flip-11.6", "p that is not normalised"),
    ("line * ((mean - v) / s)", "line * ((v - mean) / s)", "contact-rule", "a kick with the wrong sign"),
    ("(r_e**2 * L - L.T)", "(r_e**2 * L.T - L)", "pdot-rod", "a transposed gradient"),
    ("return Ap - p * (p @ Ap)", "return Ap", "pdot-rod", "p(p·Dp) left out"),
    (") / math.sin(theta)\n", ")\n", "contact-angles", ""),
    (
        "/ math.sin(theta)\n    theta_rate = (rate[0] * math.cos(phi) + rate[1] * math.sin(phi)) * math.cos(theta) - \
         rate[2] * math.sin(theta)",
        "\n    theta_rate = (rate[0] * math.cos(phi) + rate[1] * math.sin(phi)) * math.sin(theta) - rate[2] * \
         math.cos(theta)",
        "contact-angles",
        "A.13 as in the text",
    ),
];

/// The means of isotropic rods, of equal and of unequal r_e, show mistakes of the flow too.
const PLANTED_IN_MEANS: &[(&str, &str, &str, &str)] = &[
    ("np.array(gradient, dtype=float)", "0.5 * np.array(gradient, dtype=float)", "isotropic-3", "half the shear rate"),
    ("np.array(gradient, dtype=float)", "0.5 * np.array(gradient, dtype=float)", "unequal-rods", "half the shear rate"),
    // Their means |p_i| are the same.
    (
        "(r_e**2 * L - L.T)",
        "(r_e**2 * L.T - L)",
        "unequal-rods",
        "p_1 and p_2 exchanged or of a transposed gradient or of Λ with the wrong sign (1/r_e for r_e)",
    ),
    ("np.linspace(-8, 8, 801) if sd else np.zeros(1)", "np.zeros(1)", "unequal-rods", "rods of one r_e, the mean"),
];

/// Runs scripts in one interpreter, each on the problems of its folder: importing NumPy takes longer than most of them.
const DRIVER: &str = "
import runpy, sys
for line in open(sys.argv[1]).read().splitlines():
    sys.argv = line.split('\\t')
    runpy.run_path(sys.argv[0], run_name='__main__')
";

#[test]
fn each_planted_mistake_gets_its_own_name_and_the_unspoilt_code_none() {
    let Some(python) = python("numpy") else {
        return skipped("planted mistakes in numpy_rk4.py", "no python3 with numpy");
    };
    let dir = tempfile::tempdir().unwrap();
    let code = fs::read_to_string(peers().join("numpy_rk4.py")).unwrap();
    // Rods, tensors and contacts that show the mistakes, and no more.
    let all = ["mid-flip-2", "mid-flip-11.6", "disc-0.1", "isotropic-3", "pdot-rod", "contact-rule", "contact-angles"];
    let mut jobs = vec![("unspoilt".to_owned(), code.clone(), &all[..])];
    let planted: Vec<_> = PLANTED.iter().chain(PLANTED_IN_MEANS).collect();
    for (k, (line, mistake, shows, _)) in planted.iter().enumerate() {
        assert!(code.contains(line), "{line}");
        let spoilt = code.replace(line, mistake);
        jobs.push((format!("spoilt-{k}"), spoilt, std::slice::from_ref(shows)));
    }
    let place = |name: &str, part: &str| dir.path().join(name).join(part);
    let mut list = String::new();
    for (name, code, problems) in &jobs {
        some(&place(name, "ref"), problems);
        fs::write(place(name, "code.py"), code).unwrap();
        let words = ["code.py", "ref", "mine"].map(|part| place(name, part).display().to_string());
        list += &(words.join("\t") + "\n");
    }
    let (driver, jobs_file) = (dir.path().join("driver.py"), dir.path().join("jobs"));
    fs::write(&driver, DRIVER).unwrap();
    fs::write(&jobs_file, list).unwrap();
    run(&python, &[&driver, &jobs_file]);

    let judge = |name: &str| files(&place(name, "ref"), &place(name, "mine"));
    let unspoilt = judge("unspoilt");
    assert_eq!(unspoilt.code, Some(0), "{}", unspoilt.words);
    for name in all {
        assert_eq!(unspoilt.of(name)["diagnosis"], Value::Null);
    }
    planted.par_iter().enumerate().for_each(|(k, (_, mistake, shows, expected))| {
        let spoilt = judge(&format!("spoilt-{k}"));
        assert_eq!((spoilt.code, spoilt.verdict(shows)), (Some(1), "FAIL"), "{mistake}: {}", spoilt.words);
        let diagnosis = spoilt.diagnosis(shows);
        // Half of the printed A.13 is a mistake that nobody has named.
        assert!(
            diagnosis.contains(expected) && diagnosis.is_empty() == expected.is_empty(),
            "{mistake}: {diagnosis:?} for {expected}: {}",
            spoilt.words
        );
        let several = |text: &str| text.contains(" or of ");
        assert_eq!(several(diagnosis), several(expected), "{mistake}: {diagnosis}");
    });
}
