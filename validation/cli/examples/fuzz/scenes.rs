//! Scene files and arguments of `sweep`.

use crate::{Taken, Target};
use shearbed::run::{memory, run_replica};
use shearbed::{Error, Plan};
use shearbed_validation::input::scenes;
use shearbed_validation::input::start::Starts;
use shearbed_validation::serve::sweep::{Axis, KeyValue, points, scene_with};

/// Rods times steps and outputs of one replica that is run: milliseconds.
const WORK: u64 = 20_000;
const BYTES: u64 = 16 << 20;

/// Every built-in scene, small enough to be run, and flows that they do not have.
fn corpus() -> Vec<String> {
    let small = |text: &str| -> String {
        let line = |line: &str| match line.split_once(" = ") {
            Some(("count", _)) => "count = 20\n".into(),
            Some(("replicas", _)) => "replicas = 2\n".into(),
            Some(("periods", _)) => "periods = 1\n".into(),
            _ => format!("{line}\n"),
        };
        text.lines().map(line).collect()
    };
    let mut all: Vec<_> = scenes::ALL.iter().map(|scene| small(scene.text)).collect();
    for (gradient, orbits) in [
        ("[[0,0,0],[0.5,0,0],[0,0,0]]", "\"orbit_constant\", "),
        ("[[1,0,0],[0,-0.5,0.25],[0,0.5,-0.5]]", ""),
        ("[[-1,-1,0],[-2,2,-1],[0,-2,-1]]", ""),
    ] {
        for time in ["periods = 1\noutputs_per_period = 8", "strain = 3\noutputs_per_strain = 4"] {
            all.push(format!(
                "title = \"t\"\n[flow]\ngradient_per_s = {gradient}\n[particles]\ncount = 9\nlength_mm = 0.7\n\
                 aspect_ratio = 2\naspect_ratio_sd_percent = 1\norientation = {{ phi_deg = 10, theta_deg = 80 }}\n\
                 [time]\n{time}\n[output]\n\
                 observables = [\"projections\", {orbits}\"orientation_tensor\", \"mean_angle\"]\n"
            ));
        }
    }
    all
}

/// Scene files: read, planned, and run where that is soon done.
pub fn scene() -> Target {
    Target {
        name: "scene",
        corpus: corpus().into_iter().map(|text| vec![("scene.toml", text.into_bytes())]).collect(),
        take: Box::new(|_, files| {
            // The program refuses other bytes with the line before the core sees them.
            let Ok(text) = std::str::from_utf8(&files[0].1) else {
                return Ok(Taken::Refused("not UTF-8".into()));
            };
            let error = match Plan::parse("scene.toml", text) {
                Ok(plan) => return run(&plan),
                Err(error) => error,
            };
            let lines = text.lines().count() + 1;
            let Error::Text { problems, .. } = &error else { return Err(format!("no line is named: {error}")) };
            for problem in problems {
                if !problem.line.is_some_and(|line| (1..=lines).contains(&line)) {
                    return Err(format!("line {:?} of {lines}: {}", problem.line, problem.message));
                }
                names(&problem.message)?;
            }
            let message = error.to_string();
            let names_it = message.starts_with("scene.toml:");
            if names_it { Ok(Taken::Refused(message)) } else { Err(format!("the file is not named: {message}")) }
        }),
    }
}

/// A value that is refused stands there with its key and what is allowed.
fn names(message: &str) -> Result<(), String> {
    let value = message.contains("is not allowed");
    let allowed = message.split_once("is not allowed").is_none_or(|(_, rest)| rest.len() > 4);
    if !message.is_empty() && (!value || message.contains(" = ")) && allowed {
        Ok(())
    } else {
        Err(format!("no key, value or what is allowed: {message:?}"))
    }
}

fn run(plan: &Plan) -> Result<Taken, String> {
    let work = (plan.steps() + plan.outputs() as u64).saturating_mul(plan.scene().particles.count as u64);
    if work > WORK || memory::bytes(plan, 1) > BYTES {
        return Ok(Taken::Accepted);
    }
    let replica = match run_replica(plan, 0) {
        Ok(replica) => replica,
        Err(error) => return Ok(Taken::Refused(error.to_string())),
    };
    for output in 0..plan.outputs() {
        let mut trace = 0.0;
        for channel in plan.observables().into_iter().flat_map(|observable| observable.channels()) {
            let mean = replica.mean(channel, output).ok_or("no mean of a channel")?;
            if !mean.is_finite() {
                return Err(format!("{} = {mean} at output {output}", channel.name()));
            }
            if ["a11", "a22", "a33"].contains(&channel.name().as_str()) {
                trace += mean;
            }
        }
        // A sum of squares of doubles of length 1.
        if trace != 0.0 && (trace - 1.0).abs() > 1e-9 {
            return Err(format!("the trace is {trace} at output {output}"));
        }
    }
    Ok(Taken::Accepted)
}

/// What stands after `--over` and `--set`, on a scene.
pub fn sweep() -> Target {
    let text = scenes::find("fig4-n50").map(|scene| scene.text).unwrap_or_default();
    let arguments = [
        "interaction.alpha=0.1:1:4",
        "interaction.update=rotation,angles",
        "particles.count=50,100",
        "particles.orientation={ phi_deg = 0, theta_deg = 90 },\"isotropic\"",
        "time.periods=1:2:2",
        "title=\"a, b\",c",
        "output.observables=[\"projections\", \"mean_angle\"],[\"projections\"]",
        "ensemble={ replicas = 5, seed = 3 }",
        "flow.gradient_per_s=[[0,0,0],[0.5,0,0],[0,0,0]]",
    ];
    Target {
        name: "sweep",
        corpus: arguments.map(|argument| vec![("argument", argument.as_bytes().to_vec())]).to_vec(),
        take: Box::new(move |_, files| {
            // Arguments that are no texts clap refuses.
            let Ok(argument) = std::str::from_utf8(&files[0].1) else {
                return Ok(Taken::Refused("not UTF-8".into()));
            };
            let set = KeyValue::parse(argument).and_then(|setting| scene_with(text, &[setting]));
            let axis = match Axis::parse(argument) {
                Ok(axis) => axis,
                Err(why) if why.is_empty() => return Err("no reason".into()),
                Err(why) => return Ok(Taken::Refused(why)),
            };
            if axis.values.len() > 64 {
                return Ok(Taken::Accepted);
            }
            let found = points(text, &Starts::default(), &[], std::slice::from_ref(&axis));
            match found.map_err(|error| error.to_string()) {
                Ok(found) if found.len() != axis.values.len() => Err(format!("{} points", found.len())),
                Ok(found) if found.len() == 1 && set.as_ref().ok() != Some(found[0].plan.scene()) => {
                    Err(format!("--set and --over make different scenes: {set:?}"))
                }
                Ok(_) => Ok(Taken::Accepted),
                Err(why) => Taken::refused_at(&axis.key, why),
            }
        }),
    }
}
