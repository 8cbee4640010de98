//! `shearbed reference`.

mod density;
mod flows;
mod values;

use super::shape::positive;
use super::{Failure, print, progress, refuse, spares};
use shearbed_validation::files::text::{Shown, complain};
use shearbed_validation::files::{FileError, output};
use shearbed_validation::oracle::diffusion::{self, NoAnswer, strain_rate_per_s};
use shearbed_validation::oracle::reference::big::digits;
use shearbed_validation::oracle::reference::constants::{self, Constant};
use shearbed_validation::oracle::reference::diffusing::{Diffusing, Spread, WIDEST_PERCENT};
use shearbed_validation::oracle::reference::motion::{LARGEST_STRAIN, Motion, Unit};
use shearbed_validation::oracle::reference::rod::{self, Direction};
use shearbed_validation::oracle::reference::table::{self, NoValue, Start, Table};
use shearbed_validation::oracle::reference::unequal::LONGEST_TURNS;
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed reference --aspect-ratio 11.6 --start 0,90 --times 0:1:101")]
pub(super) struct Args {
    /// r_e, from 1e-100 to 1e100, or `inf` for Λ = 1
    #[arg(long, value_name = "R|inf", value_parser = values::aspect_ratio, allow_negative_numbers = true)]
    aspect_ratio: f64,
    /// Directions at t = 0: `isotropic`, `planar` (at random in the flow–gradient plane: a = diag(½, ½, 0)), one rod's
    /// φ,θ in degrees, or, with diffusion, a11,a22,a33,a12,a13,a23 of a density of Bingham, or a file of
    /// p1,p2,p3
    #[arg(long, value_name = "isotropic|planar|PHI_DEG,THETA_DEG|a11,…,a23|FILE.csv", default_value = "isotropic",
        value_parser = values::start, allow_hyphen_values = true)]
    start: From,
    /// COUNT evenly spaced times with both ends (COUNT = 1: the time FROM), or rising times with commas between
    #[arg(long, value_name = "FROM:TO:COUNT|T1,T2,…", value_parser = values::times, allow_hyphen_values = true,
        required_unless_present_any = ["constants", "explain", "steady"])]
    times: Option<Times>,
    /// What times count: periods of (mean) r_e, strain, or seconds; period unless given, and strain for r_e = inf
    #[arg(long, value_name = "period|strain|s", value_parser = values::unit_named)]
    unit: Option<Unit>,
    /// G of plane Couette flow, u_2 = G x_1
    #[arg(long, value_name = "G", default_value = "1", value_parser = values::rate, allow_negative_numbers = true)]
    shear_rate_per_s: f64,
    /// Another steady flow: nine numbers ∂u_i/∂x_j, row by row, in 1/s
    #[arg(long, value_name = "L11,L12,…,L33", value_parser = values::gradient, conflicts_with = "shear_rate_per_s",
        allow_hyphen_values = true)]
    gradient_per_s: Option<[[f64; 3]; 3]>,
    /// Flows one after another, for rods with diffusion: rows of duration_s and shear_rate_per_s, or of duration_s and
    /// l11, l12, …, l33, in 1/s; the last goes on, and times are in s
    #[arg(long, value_name = "FILE.csv", requires = "diffusion",
        conflicts_with_all = ["shear_rate_per_s", "gradient_per_s", "steady"])]
    steps: Option<PathBuf>,
    /// The flow times cos 2πt/T, for rods with --d-r-per-s; times are in s
    #[arg(long, value_name = "T", requires = "d_r_per_s", value_parser = positive, allow_negative_numbers = true,
        conflicts_with_all = ["steps", "steady", "density", "marginal"])]
    oscillation_period_s: Option<f64>,
    /// Standard deviation of a Gaussian r_e in percent of the mean, for isotropic starts and for rods with diffusion
    #[arg(long, value_name = "PERCENT", default_value = "0", value_parser = values::deviation,
        allow_negative_numbers = true)]
    aspect_ratio_sd_percent: f64,
    /// C_I: rods with rotary diffusion D_r = C_I γ̇, γ̇ = (2D:D)^½; `inf` for all directions alike
    #[arg(long, group = "diffusion", value_name = "C", value_parser = values::c_i, allow_negative_numbers = true)]
    c_i: Option<f64>,
    /// D_r of Brownian rods, also at rest (nine zeros, --unit s)
    #[arg(long, group = "diffusion", value_name = "D", value_parser = values::d_r, allow_negative_numbers = true)]
    d_r_per_s: Option<f64>,
    /// The steady distribution of rods with diffusion, in a last row at the time inf
    #[arg(long, requires = "diffusion")]
    steady: bool,
    /// The fourth moments a_ijkl in place of the other means over rods
    #[arg(long)]
    fourth: bool,
    /// Order parameter, extinction angle and birefringence too, of rods with diffusion
    #[arg(long, requires = "diffusion")]
    optics: bool,
    /// What does not change with time: T, ⟨φ⟩, C_b, means over phases, plateaus
    #[arg(long, conflicts_with_all = ["times", "unit", "fourth", "diffusion", "aspect_ratio_sd_percent", "explain"])]
    constants: bool,
    /// A file for the density ψ(φ, θ) of rods with diffusion at the times: values every 5°, or a map for each time
    #[arg(long, value_name = "FILE.csv|.svg|.png|.pdf", requires = "diffusion", requires = "times",
        conflicts_with = "steady", value_parser = values::density_file)]
    density: Option<PathBuf>,
    /// A file for the density of φ alone, per rad, every 5°
    #[arg(long, value_name = "FILE.csv", requires = "diffusion", requires = "times", conflicts_with = "steady")]
    marginal: Option<PathBuf>,
    /// Say what each column is, its unit and its equation, and compute nothing
    #[arg(long)]
    explain: bool,
    /// A file for the CSV, in place of standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Overwrite an existing file that has other contents
    #[arg(long)]
    force: bool,
}

impl Args {
    pub(super) fn only_prints(&self) -> bool {
        self.out.is_none()
    }
}

/// The value of `--start`.
#[derive(Clone, Debug)]
enum From {
    Isotropic,
    Planar,
    Rod(Direction),
    Bingham([[f64; 3]; 3]),
    Directions(PathBuf),
}

#[derive(Clone, Debug)]
struct Times(Vec<f64>);

/// Prints or writes reference values.
pub(super) fn reference(args: &Args) -> Result<(), Failure> {
    let asked_for: Vec<&PathBuf> = [&args.out, &args.density, &args.marginal].into_iter().flatten().collect();
    if args.force && asked_for.is_empty() {
        return Err(Failure::Input("--force: needs --out, --density or --marginal".into()));
    }
    let directions = if let From::Directions(path) = &args.start { Some(path) } else { None };
    for (k, file) in asked_for.iter().enumerate() {
        if asked_for[..k].iter().any(|other| output::place(other) == output::place(file)) {
            return Err(FileError::whole(file, "is given twice; two files are needed").into());
        }
        spares(file, [file.to_path_buf()], args.steps.iter().chain(directions).cloned())?;
    }
    let mut files = Vec::new();
    let rate = args.shear_rate_per_s;
    let couette = [[0.0; 3], [rate, 0.0, 0.0], [0.0; 3]];
    let motion = Motion { gradient_per_s: args.gradient_per_s.unwrap_or(couette), aspect_ratio: args.aspect_ratio };
    let text = if args.constants {
        let direction = match args.start {
            From::Isotropic => None,
            From::Rod(direction) => Some(direction),
            _ => return Err(Failure::Input("--constants: isotropic or angles are allowed as --start".into())),
        };
        constants_csv(&constants::constants(&motion, direction).ok_or_else(|| no_couette("--constants"))?)
    } else {
        let asked = asked(args, &motion)?;
        if args.explain {
            explained(&asked)
        } else {
            let text = csv(&values(args, &motion, &asked).map_err(|why| refused(args, why))?);
            if let Some(d_r) = args.d_r_per_s {
                complain(&peclet(&motion, &asked, d_r));
            }
            if let (Asked::Diffusing(rods), Some(times)) = (&asked, &args.times) {
                files = density::files(args, rods, &times.0)?;
            }
            text
        }
    };
    if let Some(path) = &args.out {
        files.push((path, text.clone().into_bytes(), String::new()));
    }
    if let Some((path, ..)) = files.iter().find(|(path, ..)| path.file_name().is_none()) {
        return Err(Failure::Input(format!("--out {}: is no file name", path.shown())));
    }
    for (path, bytes, _) in &files {
        output::may_write(path, bytes, args.force)?;
    }
    for (path, bytes, note) in &files {
        output::write_one(path, bytes, args.force)?;
        complain(note);
    }
    if args.only_prints() { print(&text) } else { Ok(()) }
}

/// The rods of the requested values.
enum Asked {
    Free(Start),
    Diffusing(Diffusing),
}

/// γ̇/D_r, of the fastest flow.
fn peclet(motion: &Motion, asked: &Asked, d_r: f64) -> String {
    let (rate, of) = match asked {
        Asked::Diffusing(rods) if rods.flows.len() > 1 => {
            let rates = rods.flows.iter().map(|(gradient, _)| strain_rate_per_s(*gradient));
            (shearbed_validation::oracle::worst(rates), " of the fastest flow")
        }
        _ => (strain_rate_per_s(motion.gradient_per_s), ""),
    };
    format!("note: the Péclet number γ̇/D_r{of} is {}\n", if rate == 0.0 { 0.0 } else { rate / d_r.abs() })
}

fn asked(args: &Args, motion: &Motion) -> Result<Asked, Failure> {
    let sd = args.aspect_ratio_sd_percent;
    let steps = args.steps.as_ref().map(|path| flows::read(path)).transpose()?;
    let flows = steps.unwrap_or_else(|| vec![(motion.gradient_per_s, f64::INFINITY)]);
    let strains = flows.iter().any(|(gradient, _)| strain_rate_per_s(*gradient) > 0.0);
    let spread = match (args.c_i, args.d_r_per_s) {
        (Some(c_i), _) => Some(Spread::CI(if strains { c_i } else { 0.0 })),
        (None, d_r) => d_r.map(Spread::PerS),
    };
    let spreads = !matches!(spread, None | Some(Spread::CI(0.0) | Spread::PerS(0.0)));
    // Without diffusion the rods are free; their means have full precision, but there is no steady distribution.
    if let Some(spread) = spread.filter(|_| spreads || args.steady) {
        if sd > WIDEST_PERCENT
            || sd > 0.0 && (args.aspect_ratio.is_infinite() || args.density.is_some() || args.marginal.is_some())
        {
            return Err(Failure::Input(format!(
                "--aspect-ratio-sd-percent {sd}: with diffusion 0 to {WIDEST_PERCENT} is allowed, of a finite \
                 --aspect-ratio, without --density and --marginal"
            )));
        }
        let start = match &args.start {
            From::Isotropic => diffusion::Start::Isotropic,
            From::Planar => diffusion::Start::Plane([0.0, 0.0, 1.0]),
            From::Bingham(k) => diffusion::Start::Bingham(*k),
            // Kept to the end of the program: the start of one command.
            From::Directions(path) => diffusion::Start::Directions(flows::directions(path)?.leak()),
            From::Rod(direction) => diffusion::Start::Direction(rod::nearest(*direction)),
        };
        return Ok(Asked::Diffusing(Diffusing {
            aspect_ratio: args.aspect_ratio,
            aspect_ratio_sd_percent: sd,
            flows,
            oscillation_s: args.oscillation_period_s,
            spread,
            start,
            fourth: args.fourth,
            optics: args.optics,
            steady: args.steady,
        }));
    }
    let needs = [
        ("--steps", args.steps.is_some()),
        ("--oscillation-period-s", args.oscillation_period_s.is_some()),
        ("--density", args.density.is_some()),
        ("--marginal", args.marginal.is_some()),
        ("--optics", args.optics),
        ("--start a11,…,a23", matches!(args.start, From::Bingham(_))),
        ("--start FILE.csv", matches!(args.start, From::Directions(_))),
    ];
    refuse(needs.iter().find(|(_, given)| *given), |(flag, _)| {
        format!("{flag}: needs rods that diffuse; a --c-i or --d-r-per-s above 0 is allowed")
    })?;
    let fourth = args.fourth;
    Ok(Asked::Free(match args.start {
        From::Isotropic => Start::Isotropic { aspect_ratio_sd_percent: sd, fourth },
        _ if sd != 0.0 => return Err(isotropic_only(&format!("--aspect-ratio-sd-percent {sd}"))),
        From::Rod(_) if fourth => return Err(isotropic_only("--fourth")),
        From::Rod(direction) => Start::Rod(direction),
        _ => Start::Planar { fourth },
    }))
}

fn unit(args: &Args) -> Unit {
    args.unit.unwrap_or(match args.aspect_ratio.is_finite() {
        _ if args.steps.is_some() || args.oscillation_period_s.is_some() => Unit::Second,
        true => Unit::Period,
        false => Unit::Strain,
    })
}

fn values(args: &Args, motion: &Motion, asked: &Asked) -> Result<Table, NoValue> {
    let unit = unit(args);
    let times = args.times.as_ref().map_or(&[][..], |times| &times.0);
    match asked {
        Asked::Free(start) => {
            // Fewer take less than a second.
            let bar = progress(times.len() as u64, "times", times.len() < 1000);
            let table = table::table(motion, *start, times, unit, || bar.inc(1));
            bar.finish_and_clear();
            table
        }
        Asked::Diffusing(rods) => rods.table(times, unit),
    }
}

fn csv(table: &Table) -> String {
    let header = table.columns.iter().map(|column| column.name.clone()).collect();
    let row = |row: &Vec<Option<f64>>| row.iter().map(|x| x.map_or(String::new(), |x| format!("{x:?}"))).collect();
    let lines = std::iter::once(header).chain(table.rows.iter().map(row));
    lines.map(|fields: Vec<String>| fields.join(",") + "\n").collect()
}

fn constants_csv(constants: &[Constant]) -> String {
    let mut text = String::from("quantity,value,unit,equation\n");
    for constant in constants {
        let value = digits(&constant.value, 25);
        text += &format!("{},{value},{},\"{}\"\n", constant.quantity, constant.unit, constant.equation);
    }
    text
}

fn explained(asked: &Asked) -> String {
    let (columns, digits) = match asked {
        Asked::Free(start) => (
            table::columns(*start),
            "Values are correctly rounded doubles at exactly the time in the unit of --unit; the other times are \
             rounded. With --aspect-ratio-sd-percent they are rounded to eleven decimals.",
        ),
        Asked::Diffusing(rods) => (
            rods.columns(),
            "The density is that of rods with rotary diffusion, C_I γ̇ (Folgar & Tucker 1984) or as given, without a \
             closure. \
             Values are rounded to the decimals that two solutions of different degree, order and step agree on, \
             eleven at most. The last row of --steady has the time inf.",
        ),
    };
    let line = |column: &table::Column| format!("{:<10} {:<4} {}\n", column.name, column.unit, column.equation);
    let text: String = columns.iter().map(line).collect();
    format!("{text}Numbers before words are equations of Lee & Springer (1982). {digits}\n")
}

fn no_couette(flag: &str) -> Failure {
    Failure::Input(format!(
        "{flag}: this flow has none; plane Couette flow (--shear-rate-per-s G or a gradient with L21 alone) and a \
         finite --aspect-ratio are allowed"
    ))
}

fn isotropic_only(flag: &str) -> Failure {
    let allowed = if flag == "--fourth" { "isotropic, or planar," } else { "isotropic" };
    Failure::Input(format!("{flag}: needs many rods; only --start {allowed} is allowed with it"))
}

fn refused(args: &Args, why: NoValue) -> Failure {
    let (flag, allowed) = match args.d_r_per_s {
        Some(d_r) => (format!("--d-r-per-s {d_r:?}"), "a larger D_r is"),
        None => (format!("--c-i {:?}", args.c_i.unwrap_or_default()), "a larger C_I is"),
    };
    let weak = "(in plane Couette flow from C_I = D_r/γ̇ = 1e-5 on, in any flow from about 1e-4 on)";
    Failure::Input(match why {
        NoValue::Past => {
            let (flag, _) = flag.split_once(' ').unwrap_or_default();
            format!("--times: rods with diffusion have no past; times from 0 are allowed with {flag}")
        }
        NoValue::Steady(NoAnswer::Unsettled) => format!(
            "--steady: nothing settles with {flag} in this flow; a C_I above 0 and a flow that strains are allowed, or \
             a --d-r-per-s above 0"
        ),
        NoValue::Steady(why) => format!("--steady with {flag}: {why}; {allowed} allowed {weak}"),
        NoValue::Diffusion(NoAnswer::RoughStart) if matches!(args.start, From::Bingham(_)) => {
            "--start: this density is too narrow to be resolved; a least eigenvalue from about 0.01 on is allowed"
                .into()
        }
        NoValue::Diffusion(NoAnswer::RoughStart) => {
            "--density, --marginal: at 0 s rods of --start planar, of angles or of a file have single directions; \
             later times are allowed"
                .into()
        }
        NoValue::Diffusion(why) if !matches!(args.start, From::Isotropic | From::Bingham(_)) => format!(
            "--times with {flag}: {why}: rods of --start planar, of angles or of a file spread from a width of 0; \
             {allowed} allowed, or a later first time after 0 (D_r t from about 1e-4 on, and D_r/γ̇ from about 1e-4 on)"
        ),
        NoValue::Diffusion(why) => format!(
            "--times with {flag}: {why}; a larger C_I, shorter --times or a longer period are allowed (from C_I = \
             D_r/γ̇ = 1e-4 on, a strain of 100; at 1e-5, of 10), and --steady"
        ),
        NoValue::Unit if args.steps.is_some() => "--unit: the times of --steps are in s, which alone is allowed".into(),
        NoValue::Unit if args.oscillation_period_s.is_some() => {
            "--unit: the times of a flow that oscillates are in s, which alone is allowed".into()
        }
        NoValue::Unit => format!(
            "--unit{}: this flow has no such unit of time; s is allowed, strain where it stretches, and period in \
             plane Couette flow (--shear-rate-per-s G) of rods with a finite r_e",
            if args.unit.is_none() { " is missing, and periods are its default" } else { "" }
        ),
        NoValue::Strain => format!(
            "--times: |L|t is above {LARGEST_STRAIN}, the most that is allowed where rods have no period: in flows \
             other than plane Couette flow, or at an infinite aspect ratio"
        ),
        NoValue::Time => {
            "--times: a time in s, strain or periods is no finite double; smaller times are allowed".into()
        }
        NoValue::Unequal => format!(
            "--aspect-ratio-sd-percent {}: is allowed in plane Couette flow, up to {LONGEST_TURNS} periods, without \
             --fourth, for r_e from 1e-4 to 1e4 of which eight standard deviations do not reach 1 or 0",
            args.aspect_ratio_sd_percent
        ),
    })
}
