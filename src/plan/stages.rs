//! The stages of a run, and whether a scene needs them.

use crate::observable::Observable;
use crate::scene::{Interaction, Orientation, Scene};
use serde::Serialize;
use std::fmt;

/// A part of a run that can be dropped.
///
/// ```
/// use shearbed::{Plan, Scene, plan::Stage};
/// // Free rods need no neighbours.
/// assert!(!Plan::new(&Scene::default())?.runs(Stage::Neighbours));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Stage {
    /// Draw Gaussian aspect ratios (eq. 11).
    AspectRatios,
    /// Draw Gaussian lengths.
    Lengths,
    /// Draw isotropic directions (eq. 12).
    Orientations,
    /// Draw positions in the control volume (eq. 12).
    Positions,
    /// Take time steps in which rods are carried by the liquid and replaced (eqs 3 and 14).
    Translation,
    /// Sort rods into cells and find nearest neighbours.
    Neighbours,
    /// Draw one R per rod and step (eqs 8 and 9).
    CollisionDraws,
    /// Apply the contact rule to colliding pairs (eqs 5 and 6, A.7 to A.14).
    Contacts,
    /// Take time steps in which free rods turn at random.
    Diffusion,
    /// Compute an observable.
    Observe(Observable),
    /// Keep every rod at some outputs.
    Rods,
    /// Sum how far rods differ, for standard errors over rods.
    RodErrors,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match self {
            Self::AspectRatios => "aspect ratios",
            Self::Lengths => "lengths",
            Self::Orientations => "orientations",
            Self::Positions => "positions",
            Self::Translation => "translation",
            Self::Neighbours => "neighbours",
            Self::CollisionDraws => "collision draws",
            Self::Contacts => "contacts",
            Self::Diffusion => "rotary diffusion",
            Self::Observe(observable) => return f.pad(&observable.name().replace('_', " ")),
            Self::Rods => "every rod",
            Self::RodErrors => "errors over rods",
        };
        f.pad(text)
    }
}

/// One line of a plan.
///
/// ```
/// let plan = shearbed::Plan::new(&shearbed::Scene::default())?;
/// for entry in plan.entries().iter().filter(|entry| !entry.kept) {
///     println!("left out: {}, as {}", entry.stage, entry.reason);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// The stage.
    pub stage: Stage,
    /// True if the stage runs.
    pub kept: bool,
    /// Why the stage runs or does not.
    pub reason: String,
}

/// The reason why no rods of this scene can collide, or `None` if they can.
pub(crate) fn no_interaction(scene: &Scene) -> Option<&'static str> {
    match &scene.interaction {
        None => Some("no [interaction] table: free rods"),
        Some(Interaction { alpha: 0.0, .. }) => Some("alpha = 0: the collision probability is 0"),
        Some(_) if scene.particles.count == 1 => Some("one rod has no neighbour"),
        Some(_) => None,
    }
}

pub(super) fn entries(scene: &Scene) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut add = |stage, kept, reason: &str| {
        entries.push(Entry { stage, kept, reason: reason.to_owned() });
    };
    let particles = &scene.particles;
    let file = particles.rods.as_ref().map_or("", |rods| &rods.file);
    match (particles.own_aspect_ratios(), particles.of_several_shapes()) {
        (Some(_), _) => add(Stage::AspectRatios, true, &format!("each rod has its own, of {file}")),
        (None, true) => add(Stage::AspectRatios, true, "Gaussian aspect ratios are drawn"),
        (None, false) => add(Stage::AspectRatios, false, "standard deviation 0: all rods share the mean"),
    }
    if particles.of_several_lengths() {
        let asked = [
            (no_interaction(scene).is_none(), "P_c and contact arms use each rod's own length"),
            (
                scene.output.observables.iter().any(|observable| observable.weighs_rods()),
                "a rod's stress is proportional to its cubed length",
            ),
            (scene.output.rods_key().is_some(), "rods.csv has each rod's length"),
        ];
        let of_whom = match particles.own_lengths_mm() {
            Some(_) => format!("each rod has its own, of {file}"),
            None => "Gaussian lengths are drawn".to_owned(),
        };
        match asked.into_iter().find(|(asked, _)| *asked) {
            Some((_, why)) => add(Stage::Lengths, true, &format!("{of_whom}: {why}")),
            None => add(Stage::Lengths, false, "free rods of any length turn alike"),
        }
    }
    let of_file = particles.own().is_some_and(|own| own.p.is_some());
    match &particles.orientation {
        _ if of_file => add(Stage::Orientations, false, &format!("every rod starts as in {file}")),
        Orientation::Random(_) => add(Stage::Orientations, true, "isotropic directions are drawn"),
        Orientation::Given { .. } => add(Stage::Orientations, false, "every rod starts at the given angles"),
    }
    let free = no_interaction(scene);
    for (stage, why) in [
        (Stage::Positions, "distances between rods are needed"),
        (Stage::Translation, "the liquid carries rods past each other, step by step"),
        (Stage::Neighbours, "each rod meets its nearest neighbour"),
        (Stage::CollisionDraws, "P_c > R decides who collides"),
        (Stage::Contacts, "colliding rods share their velocity along the contact line"),
    ] {
        add(stage, free.is_none(), free.unwrap_or(why));
    }
    if scene.diffuses() {
        add(Stage::Diffusion, true, "free rods turn at random, step by step");
    }
    for &observable in &scene.output.observables {
        add(Stage::Observe(observable), true, "asked for by the scene");
    }
    if let Some(key) = scene.output.rods_key() {
        add(Stage::Rods, true, &format!("asked for by {key}"));
    }
    entries.push(rod_errors(scene));
    entries
}

/// The stage of standard errors over rods, which are used for a single replica.
pub(super) fn rod_errors(scene: &Scene) -> Entry {
    let kept = scene.ensemble.replicas == 1;
    let reason =
        if kept { "one replica: standard errors come from the rods" } else { "standard errors come from the replicas" };
    Entry { stage: Stage::RodErrors, kept, reason: reason.to_owned() }
}
