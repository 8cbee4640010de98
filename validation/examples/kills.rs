//! Kills a run with a checkpoint at random moments, so often as asked, and lets it end: how much each kill cost, whether the file
//! was whole after each, and whether the results are those of a run that was not killed.
//!
//!     cargo build --release && cargo run --release -p shearbed-suite --example kills -- target/release/shearbed 100

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// Seconds between checkpoints.
const EVERY_S: f64 = 0.05;
/// A run lives so long at most before it is killed, in ms.
const LIFE_MS: u64 = 400;

/// About ten seconds of work: one replica, or many.
fn scene(count: usize, periods: usize, replicas: usize) -> String {
    format!(
        "title = \"killed\"\n[flow]\nshear_rate_per_s = 0.5\n[particles]\ncount = {count}\nlength_mm = 0.72\naspect_ratio = 11.6\n\
         aspect_ratio_sd_percent = 3.6\norientation = \"isotropic\"\n[interaction]\nconcentration_per_cm3 = 50\nalpha = 0.5\n\
         [time]\nperiods = {periods}\nsteps_per_period = 200\noutputs_per_period = 1\n[ensemble]\nreplicas = {replicas}\n"
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [program, kills] = words.as_slice() else {
        return Err("kills PROGRAM NUMBER".into());
    };
    let (program, kills) = (fs::canonicalize(program)?, kills.parse::<u32>()?);
    for (name, text) in [
        ("one replica", scene(1000, 100, 1)),
        ("many replicas", scene(100, 20, 200)),
    ] {
        let dir = tempfile::tempdir()?;
        fs::write(dir.path().join("scene.toml"), text)?;
        let (most, mean, lives) = killed(&program, dir.path(), kills)?;
        println!(
            "{name}: {kills} kills in {lives} runs, every checkpoint whole, results equal; lost since the last checkpoint, which is \
             due every {EVERY_S} s: {mean:.3} s on average, {most:.3} s at most"
        );
    }
    Ok(())
}

/// The largest and the mean loss in s, and the runs that were begun anew after they had ended.
fn killed(program: &Path, dir: &Path, kills: u32) -> Result<(f64, f64, u32), Box<dyn Error>> {
    let run = |out: &str| {
        let mut command = Command::new(program);
        command
            .args(["run", "scene.toml", "--quiet", "--force", "--out", out])
            .current_dir(dir)
            .stderr(Stdio::piped());
        command
    };
    let kept = |command: &mut Command| {
        command.args(["--checkpoint", "kept", "--every", &EVERY_S.to_string()]);
    };
    if !run("whole").status()?.success() {
        return Err("the whole run failed".into());
    }
    let mut random = Pcg64Dxsm::seed_from_u64(u64::from(kills));
    let (mut most, mut sum, mut done, mut lives) = (0.0_f64, 0.0, 0, 1);
    while done < kills {
        let mut command = run("killed");
        kept(&mut command);
        let begun = SystemTime::now();
        let mut child = command.spawn()?;
        sleep(Duration::from_millis(random.random_range(1..LIFE_MS)));
        if child.try_wait()?.is_some_and(|status| status.success()) {
            compare(dir)?;
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
    let mut last = run("killed");
    kept(&mut last);
    let output = last.output()?;
    match output.status.success() {
        true => compare(dir)?,
        false => return Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
    }
    Ok((most, sum / f64::from(done.max(1)), lives))
}

fn compare(dir: &Path) -> Result<(), Box<dyn Error>> {
    let read = |out: &str| fs::read(dir.join(out).join("projections.csv"));
    match read("whole")? == read("killed")? {
        true => Ok(()),
        false => Err("the results are others".into()),
    }
}
