//! Kills runs with a checkpoint at random moments, so often as asked, and lets them end: how much each kill cost, whether the file
//! was whole after each, and whether the results are those of a run that was not killed.
//!
//!     cargo build --release && cargo run --release -p shearbed-suite --example kills -- target/release/shearbed 100

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use serde_json::Value;
use std::error::Error;
use std::fs;
use std::iter::once;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// Seconds between checkpoints.
const EVERY_S: f64 = 0.05;
/// About ten seconds of work: one replica, or many.
fn scene(count: usize, periods: usize, replicas: usize) -> String {
    format!(
        "title = \"killed\"\n[flow]\nshear_rate_per_s = 0.5\n[particles]\ncount = {count}\nlength_mm = 0.72\naspect_ratio = 11.6\n\
         aspect_ratio_sd_percent = 3.6\norientation = \"isotropic\"\n[interaction]\nconcentration_per_cm3 = 50\nalpha = 0.5\n\
         [time]\nperiods = {periods}\nsteps_per_period = 200\noutputs_per_period = 1\n[ensemble]\nreplicas = {replicas}\n"
    )
}

/// Cases that take less than a second each, with what they are run by.
const CASES: [&str; 8] = [
    "kick-bound",
    "kick-formula",
    "mirrored-flow",
    "other-axes-decay",
    "particle-stress",
    "period-unaffected",
    "replacement",
    "spread-damping",
];

/// What a folder of results holds.
type Bytes = Result<Vec<u8>, Box<dyn Error>>;

/// A command that is killed.
struct Work {
    name: &'static str,
    words: Vec<String>,
    /// How often it keeps its state.
    every: Vec<String>,
    /// It lives so long at most before it is killed, in ms.
    life_ms: u64,
    results: fn(&Path) -> Bytes,
}

impl Work {
    fn of_run(name: &'static str) -> Self {
        Self {
            name,
            words: ["run", "scene.toml", "--force"].map(String::from).into(),
            every: vec!["--every".into(), EVERY_S.to_string()],
            life_ms: 400,
            results: |out| Ok(fs::read(out.join("projections.csv"))?),
        }
    }

    /// Each case is kept when it is finished.
    fn of_cases() -> Self {
        let cases = CASES.iter().flat_map(|case| ["--case", case]);
        Self {
            name: "cases",
            words: once("validate").chain(cases).map(String::from).collect(),
            every: Vec::new(),
            life_ms: 3000,
            results: |out| {
                let mut report: Value = serde_json::from_slice(&fs::read(out.join("report.json"))?)?;
                let cases = report["cases"].as_array_mut().ok_or("no cases")?;
                cases.iter_mut().for_each(|case| case["seconds"] = 0.into());
                Ok(report["cases"].to_string().into())
            },
        }
    }

    fn command(&self, program: &Path, dir: &Path, out: &str) -> Command {
        let mut command = Command::new(program);
        command
            .args(&self.words)
            .args(["--quiet", "--out", out])
            .current_dir(dir)
            .stderr(Stdio::piped());
        command
    }

    fn kept(&self, program: &Path, dir: &Path) -> Command {
        let mut command = self.command(program, dir, "killed");
        command.args(["--checkpoint", "kept"]).args(&self.every);
        command
    }

    /// That the run which was killed ended as the other.
    fn compare(&self, dir: &Path) -> Result<(), Box<dyn Error>> {
        let read = |out: &str| (self.results)(&dir.join(out));
        match read("whole")? == read("killed")? {
            true => Ok(()),
            false => Err("the results are others".into()),
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [program, kills] = words.as_slice() else {
        return Err("kills PROGRAM NUMBER".into());
    };
    let (program, kills) = (fs::canonicalize(program)?, kills.parse::<u32>()?);
    for (work, text) in [
        (Work::of_run("one replica"), scene(1000, 100, 1)),
        (Work::of_run("many replicas"), scene(100, 20, 200)),
        (Work::of_cases(), String::new()),
    ] {
        let dir = tempfile::tempdir()?;
        fs::write(dir.path().join("scene.toml"), text)?;
        let (most, mean, lives) = killed(&work, &program, dir.path(), kills)?;
        let due = match work.every.as_slice() {
            [] => "each case is kept at its end".to_owned(),
            _ => format!("it is due every {EVERY_S} s"),
        };
        println!(
            "{}: {kills} kills in {lives} runs, every checkpoint whole, results equal; lost since the last checkpoint ({due}): \
             {mean:.3} s on average, {most:.3} s at most",
            work.name
        );
    }
    Ok(())
}

/// The largest and the mean loss in s, and the runs that were begun anew after they had ended.
fn killed(work: &Work, program: &Path, dir: &Path, kills: u32) -> Result<(f64, f64, u32), Box<dyn Error>> {
    if !work.command(program, dir, "whole").status()?.success() {
        return Err("the whole run failed".into());
    }
    let mut random = Pcg64Dxsm::seed_from_u64(u64::from(kills));
    let (mut most, mut sum, mut done, mut lives) = (0.0_f64, 0.0, 0, 1);
    while done < kills {
        let begun = SystemTime::now();
        let mut child = work.kept(program, dir).spawn()?;
        sleep(Duration::from_millis(random.random_range(1..work.life_ms)));
        if child.try_wait()?.is_some_and(|status| status.success()) {
            work.compare(dir)?;
            fs::remove_file(dir.join("kept"))?;
            lives += 1;
            continue;
        }
        child.kill()?;
        let end = SystemTime::now();
        let output = child.wait_with_output()?;
        if output.status.code().is_some_and(|code| code != 0) {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        if output.status.success() {
            continue;
        }
        done += 1;
        if let Ok(file) = fs::metadata(dir.join("kept")) {
            // A life that ends before its first checkpoint has lost itself.
            let since = file.modified()?.max(begun);
            let lost = end.duration_since(since).unwrap_or_default().as_secs_f64();
            most = most.max(lost);
            sum += lost;
        }
    }
    let output = work.kept(program, dir).output()?;
    match output.status.success() {
        true => work.compare(dir)?,
        false => return Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
    }
    Ok((most, sum / f64::from(done.max(1)), lives))
}
