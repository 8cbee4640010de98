//! Points to fit, and folders of results that are drawn.

use crate::checkpoints::RODS;
use crate::readers::{put, refused};
use crate::{Files, Taken, Target};
use serde_json::{Value, json};
use shearbed_validation::files::output::{RECORD, Sum};
use shearbed_validation::serve::fit::data;
use std::fs;

/// Points of `shearbed fit`.
pub fn fits() -> Target {
    let with = |text: &str| vec![("a.csv", text.as_bytes().to_vec())];
    Target {
        name: "fits",
        corpus: vec![
            with("t_over_T,x1,x1_u\n0,0.5,0.01\n0.5,0.4,0.02\n1,0.3,0.01\n"),
            with("strain,strain_u,x1,x1_u,x3,x3_u\n0,,0.5,0.01,,\n10,0.5,,,0.3,0.02\n"),
            with("t_s,phi,phi_u,a12,a12_u\n0,0.7,0.1,-0.2,0.01\n80,0.8,0.1,0.1,0.01\n"),
        ],
        take: Box::new(|folder, files| {
            put(folder, files)?;
            match data::read(&folder.join("a.csv"), 0, &data::Reading::default()) {
                Ok(points) => Taken::if_finite(
                    (points.points.iter())
                        .all(|p| [p.time, p.u_time, p.value, p.u].iter().all(|x| x.is_finite()) && p.u > 0.0),
                    "a point",
                ),
                Err(error) => refused(&error, files),
            }
        }),
    }
}

const WRITTEN: [&str; 3] = ["projections.csv", "run.json", RECORD];

/// A folder of `shearbed run`.
fn folder_of_a_run() -> Vec<(&'static str, Vec<u8>)> {
    let dir = tempfile::tempdir().expect("the harness has a folder");
    let scene = dir.path().join("s.toml");
    fs::write(&scene, RODS).expect("the harness writes");
    let out = dir.path().join("out");
    let words = ["run".into(), scene.into_os_string(), "--quiet".into(), "--out".into(), out.clone().into_os_string()];
    shearbed_cli::call(words.to_vec()).expect("it runs");
    let read = |name| (name, fs::read(out.join(name)).expect("it is written"));
    WRITTEN.map(read).to_vec()
}

/// The same with a record whose checksums are right: what the files say is then to be refused, or drawn.
fn with_right_sums(files: &Files) -> Vec<(&'static str, Vec<u8>)> {
    let mut all = files.to_vec();
    let Some(record) = files.iter().position(|(name, _)| *name == RECORD) else {
        return all;
    };
    let Ok(mut value) = serde_json::from_slice::<Value>(&all[record].1) else {
        return all;
    };
    let others = files.iter().filter(|(name, _)| *name != RECORD);
    if let Some(sums) = value.get_mut("files").and_then(Value::as_object_mut) {
        sums.extend(others.map(|(name, bytes)| ((*name).to_owned(), json!(Sum::of(bytes)))));
    }
    all[record].1 = value.to_string().into_bytes();
    all
}

/// Folders of runs that `shearbed plot` reads, half of them with checksums that are right.
pub fn plots() -> Target {
    Target {
        name: "plots",
        corpus: vec![folder_of_a_run()],
        take: Box::new(|folder, files| {
            let length: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
            let set = if length.is_multiple_of(2) { files.to_vec() } else { with_right_sums(files) };
            put(folder, &set)?;
            let dirs = [folder.to_path_buf()];
            match shearbed_cli::figure(&dirs, Some("x1")) {
                Ok(figure) => {
                    let mut numbers = figure.curves.iter().flat_map(|curve| curve.x.iter().chain(&curve.y));
                    Taken::if_finite(numbers.all(|number| number.is_finite()), "a curve")
                }
                Err(why) => Taken::refused_at(&folder.display().to_string(), why),
            }
        }),
    }
}
