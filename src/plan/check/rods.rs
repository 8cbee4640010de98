//! Checks the rods' shapes and starts.

use crate::scene::{Invalid, Misfit, RodsFile, Scene, equivalent, find};

/// Checks that r_e is given once: directly, or by a cylinder and a formula that gives r_e for it.
pub(super) fn check_shape(scene: &Scene) -> Result<(), Invalid> {
    let particles = &scene.particles;
    let key = "particles.shape_correlation";
    let (r, formula) = match (particles.physical_aspect_ratio, particles.shape_correlation) {
        (None, None) => return Ok(()),
        (None, Some(given)) => {
            let allowed = "it goes with physical_aspect_ratio, which is not given";
            return Err(Invalid::new(key, format!("{:?}", given.name()), allowed));
        }
        (Some(r), None) => {
            let words = find(key).map_or_else(String::new, |key| key.holds.to_string());
            let allowed = format!("physical_aspect_ratio = {r} takes {words}");
            return Err(Invalid::missing(key, &allowed));
        }
        (Some(r), Some(correlation)) => (r, correlation.formula()),
    };
    match equivalent(Some(r), particles.shape_correlation) {
        Some(value) if value == particles.aspect_ratio => Ok(()),
        Some(value) => {
            let allowed =
                format!("either aspect_ratio or physical_aspect_ratio, of which {} makes {value}", formula.name);
            Err(Invalid::new("particles.aspect_ratio", particles.aspect_ratio, allowed))
        }
        None => {
            let allowed = format!(
                "{} ({}) gives no valid r_e there: it is above r, or falls as r grows; choose another \
                 shape_correlation",
                formula.name, formula.formula
            );
            Err(Invalid::new("particles.physical_aspect_ratio", r, allowed))
        }
    }
}

/// Fails if the scene names a file of rods that has not been loaded.
pub(in crate::plan) fn check_rods_are_read(scene: &Scene) -> Result<(), Invalid> {
    match &scene.particles.rods {
        Some(RodsFile { file, own: None, .. }) => {
            Err(refused_file(file, "a file that was loaded before planning (RodsFile::with)".into()))
        }
        _ => Ok(()),
    }
}

/// Checks that the rods of a file are complete and consistent with the scene.
pub(super) fn check_own_rods(scene: &Scene) -> Result<(), Invalid> {
    let Some(RodsFile { file, own: Some(own), .. }) = &scene.particles.rods else {
        return Ok(());
    };
    let refused = |allowed: String| Err(refused_file(file, allowed));
    let count = scene.particles.count;
    let axes = own.p.iter().chain(&own.place_mm).flatten();
    let mut columns = axes.chain(&own.aspect_ratio).chain(&own.length_mm);
    if let Some(column) = columns.find(|column| column.len() != count) {
        let has = column.len();
        return refused(format!("a row for each rod: it has {has}, and particles.count is {count}"));
    }
    match scene.misfit(own) {
        Some(Misfit { rod, column, value, allowed }) => {
            refused(format!("rod {rod} has {column} = {value:?}; allowed: {allowed}"))
        }
        None => Ok(()),
    }
}

/// Checks that the mean r_e is allowed in the scene, and that its spread stays on one side of 1.
pub(super) fn check_particles(scene: &Scene) -> Result<(), Invalid> {
    let (r, sd) = (scene.particles.aspect_ratio, scene.particles.aspect_ratio_sd_percent);
    // α = 0 gives rods a concentration, and no collision.
    if scene.interaction.as_ref().is_some_and(|interaction| interaction.alpha > 0.0) && r <= 1.0 {
        let allowed = "interacting rods need a number > 1";
        return Err(Invalid::new("particles.aspect_ratio", r, allowed));
    }
    let length_sd = scene.particles.length_sd_percent;
    if length_sd >= 100.0 / 3.0 {
        let allowed = "expected a number below 33.3333: with more, lengths ≤ 0 are less than three standard deviations \
            from the mean";
        return Err(Invalid::new("particles.length_sd_percent", length_sd, allowed));
    }
    // Three standard deviations: P(r_e ≤ 1) = 0.0013 per rod.
    let deviation = 3.0 * r * sd / 100.0;
    let too_wide = sd > 0.0 && ((r - 1.0).abs() <= deviation || r <= deviation);
    if too_wide {
        let widest = 100.0 * ((r - 1.0).abs().min(r) / (3.0 * r));
        return Err(Invalid::new(
            "particles.aspect_ratio_sd_percent",
            sd,
            format!(
                "expected a number below {widest:.4} with a mean of {r}: with more, r_e ≤ 1 (for discs: r_e ≥ 1 or ≤ \
                 0) is less than three standard deviations from the mean"
            ),
        ));
    }
    Ok(())
}

fn refused_file(file: &str, allowed: String) -> Invalid {
    Invalid::new("particles.rods", format!("{{ file = {file:?} }}"), allowed)
}
