//! The description of a problem, `README.md` of its folder.

use super::{Built, Ensemble, Kind, Metric, Problem};

/// The text of `README.md`.
pub(super) fn page(built: &Built) -> String {
    let problem = &built.problem;
    let mut page = format!("# {}\n\n{}\n\n", problem.title, problem.summary);
    page += &format!("## What is asked\n\n{}\n\n", asked(built));
    if let Some(ensemble) = &problem.ensemble {
        page += &format!("{}\n\n", model(problem, ensemble));
    }
    let mut steps = "";
    if problem.kind != Kind::Formula {
        let [x, y, z] = problem.gradient_per_s.map(|[x, y, z]| format!("[{x}, {y}, {z}]"));
        page += &format!("The flow is u = L x with L = [{x}, {y}, {z}] in 1/s, row i and column j being ∂u_i/∂x_j. ");
        if let Some([x, y, z]) = problem.rotation_rad_per_s {
            page += &format!(
                "It turns: at the time t the gradient is Q L Qᵀ + S with S p = ω × p, ω = [{x}, {y}, {z}] rad/s, and \
                 Q = exp(St), the right-handed rotation about ω by |ω|t. "
            );
        }
        steps =
            ", or one file a step size, `steps-100.csv`, `steps-200.csv` and so on, so that an order can be read off";
    }
    page += &format!(
        "Axes: {}.\n\nWrite `answer.csv` with the columns `{}`{steps}.\n\n",
        problem.axes,
        problem.columns.join(",")
    );
    page += &format!(
        "## How it is judged\n\n{} The largest counts; at most **{:e}** passes.\n\n{}\n\n",
        metric(problem.metric),
        problem.tolerance,
        problem.because
    );
    let values = match problem.kind {
        _ if problem.closed.is_some() || problem.formula.is_some() => "The equation",
        Kind::Ensemble => "The means in `certified.csv` are a reference of this program, not certified; they come from",
        _ => "The certified values in `certified.csv` come from",
    };
    // Polynomials of closures fill lines of their own.
    let (before, between) = if problem.equations.len() > 3 { ("\n\n- ", "\n- ") } else { (" ", "; ") };
    page + &format!("{values}:{before}{}.\n", problem.equations.join(between))
}

fn asked(built: &Built) -> String {
    let problem = &built.problem;
    let times = || problem.times_s.iter().map(|time| format!("{time:?}")).collect::<Vec<_>>().join(", ");
    match problem.kind {
        Kind::Rods => format!(
            "The directions at t = {2} s of the {0} of `start.csv` (`rod,p1,p2,p3` at t = 0, of aspect ratio {1}). \
             Numbers are doubles and are exact.",
            match built.start.len() {
                1 => "rod".into(),
                count => format!("{count} rods"),
            },
            aspect_ratio(problem.aspect_ratio),
            times()
        ),
        Kind::Tensor if problem.closed.is_some() => format!(
            "a_ij of the closed equation below, for rods of {}, at t = {} s. `closed` in problem.json has the closure, \
             the model with its parameters, and a_ij at t = 0.",
            aspect_ratio(problem.aspect_ratio),
            times()
        ),
        Kind::Tensor => format!(
            "Means over infinitely many {}, {} at t = 0, of aspect ratio {}{}, at t = {} s.{}",
            match (problem.c_i, problem.d_r_per_s) {
                (Some(c_i), _) => format!("rods with rotary diffusion, C_I = {c_i}"),
                (None, Some(d_r)) => format!("rods with rotary diffusion, D_r = {d_r}/s"),
                (None, None) => "free rods".to_owned(),
            },
            if problem.planar_start { "at random in the plane of axes 1 and 2" } else { "isotropic" },
            aspect_ratio(problem.aspect_ratio),
            spread(problem),
            times(),
            match problem.oscillation_period_s {
                Some(period) => format!(" The flow is `gradient_per_s` times cos 2πt/T, T = {period} s."),
                None => String::new(),
            }
        ),
        Kind::Formula => format!(
            "The values of the formula below for each of the {} rows of `inputs.csv`. Numbers are doubles and are \
             exact.",
            built.inputs.len()
        ),
        Kind::Contact => format!(
            "What the contact rule makes of each of the {} pairs of rods in `inputs.csv`: centres in mm, axes p of \
             length 1 and aspect ratios of rods a and b. Before the contact each rod turns by Jeffery's equation \
             (A.1).{}",
            built.inputs.len(),
            match problem.time_step_s {
                None => String::new(),
                Some(step) => format!(" The time step of A.14 is Δt = {step} s."),
            }
        ),
        Kind::Ensemble => format!("Means with standard errors at t = {} s.", times()),
    }
}

/// The aspect ratio as text, such as "r_e = 11.6". From 1e9 on Λ is 1 in doubles: rods without thickness.
fn aspect_ratio(r_e: f64) -> String {
    if r_e < 1e9 { format!("r_e = {r_e}") } else { format!("r_e = {r_e:e} (Λ = 1)") }
}

fn spread(problem: &Problem) -> String {
    match problem.aspect_ratio_sd_percent {
        0.0 => String::new(),
        sd => format!(" (Gaussian, standard deviation {sd} % of the mean)"),
    }
}

fn model(problem: &Problem, ensemble: &Ensemble) -> String {
    format!(
        "A replica is {} rods of length a = {} mm and r_e = {}{} in the cube [0, H]³, H = (N/n)^(1/3), at n = {} rods \
         per cm³, with α = {} and m = {}, stepped with {} steps a period T = 2π(r_e + 1/r_e)/G of the mean r_e. P_c \
         has no Δt, so the step is part of the model. At t = 0 centres are uniform in the cube and axes isotropic (eq. \
         12).\n\n\
         Each step, from the state at its start: every rod i finds its nearest neighbour j by centre distance s, \
         without images, and draws R_i uniform in [0, 1); (i, j) is a candidate when (α/(s/a + α))^m > R_i (eqs 7 to \
         9). Candidates are taken closest first, each rod in one collision at most. A pair that is parallel, or has an \
         arm of exactly 0, makes no contact. The two rods of a collision turn about p × ṗ′ by |ṗ′|Δt with ṗ′ of A.7 to \
         A.13, their contact lines being infinite; all others take Jeffery's exact step. Then x_2 grows by G x_1 Δt; a \
         rod that leaves at x_2 ≥ H comes back at x_2 − H with x_1 = H√R, x_3 = H R′ (eq. 14), its axis and r_e \
         kept.\n\n\
         x_1, x_2, x_3 in the columns are the means over rods and replicas of |p_1|, |p_2|, |p_3|; `x1_se` is the \
         standard error over replicas of x1. Take at least 1000 replicas, and enough for a standard error of {} or \
         less. The reference means are from {} replicas.",
        ensemble.count,
        ensemble.length_mm,
        problem.aspect_ratio,
        spread(problem),
        ensemble.concentration_per_cm3,
        ensemble.alpha,
        ensemble.m,
        ensemble.steps_per_period,
        ensemble.largest_standard_error,
        ensemble.certified_replicas,
    )
}

fn metric(metric: Metric) -> &'static str {
    match metric {
        Metric::Angle => {
            "The error of a row is the angle in rad between its axis and the certified one, or | |p| - 1 | if that is \
             larger; p and -p are the same rod."
        }
        Metric::Absolute => "The error of a row is the largest difference from its certified values.",
        Metric::Relative => {
            "The error of a row is, for rod a and for rod b, the length of the difference from the certified numbers \
             (the columns `a_…` or `b_…`) over the length of the certified ones."
        }
        Metric::StandardErrors => {
            "The error of a value is its difference from the reference in units of (se² + reference se²)^(1/2)."
        }
    }
}
