//! `shearbed plan` and `shearbed scenes`.

use super::facts::Facts;
use super::fit::{self, FEWEST_REPLICAS, MOST_REPLICAS};
use super::scene::{Chosen, Ensemble, Named};
use super::until::{LEAST, Until};
use super::{Failure, Threads, duration, memory, print, scene, sweep};
use shearbed::Plan;
use shearbed_validation::files::text::{left_aligned, line};
use shearbed_validation::input::{scene_keys, scenes};
use shearbed_validation::methods::least_squares::basis::MOST_PARAMETERS;
use shearbed_validation::serve::fit::Range;
use shearbed_validation::serve::sweep::Axis;

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed plan fig4-n50 --set interaction.alpha=0.3")]
pub(super) struct PlanArgs {
    #[command(flatten)]
    chosen: Chosen,
    #[command(flatten)]
    ensemble: Ensemble,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    until: Until,
    /// A key and its values or range, as `sweep` and `fit` take them: what that would cost; repeatable
    #[arg(long, value_name = "KEY=VALUES", value_parser = Over::parse)]
    over: Vec<Over>,
}

/// A key to vary: with the values of a sweep, or both ends of a fit's range.
#[derive(Clone, Debug)]
struct Over {
    axis: Axis,
    range: Option<Range>,
}

impl Over {
    fn parse(text: &str) -> Result<Self, String> {
        match Range::parse(text) {
            Ok(range) => {
                let values = vec![range.from.into(), range.to.into()];
                Ok(Self { axis: Axis { key: range.key.clone(), values }, range: Some(range) })
            }
            Err(_) => Ok(Self { axis: Axis::parse(text)?, range: None }),
        }
    }
}

/// The cost of a sweep or a fit over these keys, as text.
fn of_keys(args: &PlanArgs, named: &Named, plan: &Plan, may_run: bool) -> Result<(String, Vec<String>), Failure> {
    let over = &args.over;
    let refused = |why: String| Err(Failure::Input(format!("--over: {why}")));
    let fitted: Vec<Range> = over.iter().filter_map(|over| over.range.clone()).collect();
    let (ranges, most) = (fitted.len(), args.ensemble.replicas.unwrap_or(MOST_REPLICAS));
    if over.is_empty() {
        return Ok((String::new(), plan.warnings()));
    } else if ranges > 0 && ranges < over.len() {
        return refused("KEY=FROM:TO of a fit beside values of a sweep; one kind is allowed".to_owned());
    } else if ranges > MOST_PARAMETERS {
        return refused(format!("given {ranges} times; a fit takes up to {MOST_PARAMETERS} parameters"));
    } else if ranges > 0 && most < FEWEST_REPLICAS {
        return Err(Failure::Input(format!("--replicas {most}: a fit takes {FEWEST_REPLICAS} or more")));
    }
    if ranges > 0 {
        fit::check_ranges(named, fitted)?;
    }
    let axes: Vec<_> = over.iter().map(|over| over.axis.clone()).collect();
    let points = sweep::points(named, &axes)?;
    let plans: Vec<_> = points.iter().map(|point| &point.plan).collect();
    let cost = if ranges > 0 {
        duration::of_fit((ranges, most), &plans, may_run)
    } else {
        duration::of_sweep(&plans, may_run)
    };
    // A point has the scene's warnings too, unless its own value takes them away.
    Ok((cost, sweep::warnings(&points, &axes)))
}

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed scenes --show fig4-n50 > mine.toml")]
pub(super) struct ScenesArgs {
    /// Print this built-in scene's file, to start a scene of your own from
    #[arg(long, value_name = "NAME")]
    show: Option<String>,
    /// Print every key of a scene file: what it means, its unit, what is allowed, its default
    #[arg(long, conflicts_with = "show")]
    keys: bool,
    // Where other commands take it.
    #[arg(hide = true, conflicts_with_all = ["show", "keys"])]
    name: Option<String>,
}

/// Prints a scene's plan. Fails if `run` would fail because of memory.
pub(super) fn plan(args: &PlanArgs) -> Result<(), Failure> {
    let named = args.chosen.load(&args.ensemble, &[])?;
    let plan = named.plan()?;
    args.until.check(&plan, &named)?;
    // A plan that `run` would refuse here is still shown: it may fit on another machine.
    let fits = memory::check(&plan, args.threads.given, &named.source);
    let each_s = duration::of_replica(&plan, fits.is_ok());
    let (of_keys, warned) = of_keys(args, &named, &plan, fits.is_ok())?;
    let (plan, replicas) = if args.until.is_empty() {
        (plan, String::new())
    } else {
        let may_run = fits.is_ok() && duration::is_pilot(LEAST, each_s);
        let piloted = may_run.then(|| args.until.piloted(&plan)).flatten();
        let (replicas, text) = piloted.unwrap_or_else(|| (LEAST, args.until.planned()));
        (plan.with_replicas(replicas), text)
    };
    // The plan's text ends with its warnings, which go where those of `run` go.
    let warnings: String = plan.warnings().iter().map(|warning| format!("warning: {warning}\n")).collect();
    let text = plan.to_string();
    let stages = text.strip_suffix(&warnings).unwrap_or(&text);
    print(&format!(
        "{stages}{}{}{}{of_keys}",
        Facts::of(&plan).text(),
        duration::of_scene(&plan, each_s, args.threads.given),
        replicas
    ))?;
    scene::warn(&named.source, &warned);
    fits
}

/// Lists the built-in scenes, or prints one.
pub(super) fn scenes(args: &ScenesArgs) -> Result<(), Failure> {
    if args.keys {
        return print(&scene_keys::text());
    }
    let Some(name) = args.show.as_ref().or(args.name.as_ref()) else {
        return print(&table()?);
    };
    let Some(built_in) = scenes::find(name) else {
        let names = scenes::ALL.iter().map(|built_in| built_in.name).collect::<Vec<_>>().join(", ");
        let name = line(name);
        return Err(Failure::Input(format!("--show {name}: no built-in scene has this name; there are {names}")));
    };
    print(built_in.text)
}

fn table() -> Result<String, Failure> {
    let row = |built_in: &scenes::BuiltIn| Ok(vec![built_in.name.to_owned(), built_in.scene()?.title]);
    Ok(left_aligned(&scenes::ALL.iter().map(row).collect::<Result<Vec<_>, Failure>>()?))
}
