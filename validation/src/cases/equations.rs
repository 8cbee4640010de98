//! The paper's equations, and the code that implements them: with the registry of cases this makes the traceability
//! table.

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equation {
    /// The number, such as `15` or `A.13`.
    pub number: &'static str,
    pub says: &'static str,
    /// The implementation in a run, as `file.rs: item` (or a folder in place of the file).
    pub code: &'static [&'static str],
}

/// Every numbered equation, in the paper's order.
pub const ALL: [Equation; 35] = [
    eq("1", "aspect ratio r_e = a/b", &["scene.rs: aspect_ratio"]),
    eq("2", "velocity gradient G_ij = ∂u_i/∂x_j (text: ∂x_i)", &["flow.rs: VelocityGradient"]),
    eq("3", "liquid velocity u_i = Σ G_ij x_j", &["volume.rs: carry", "suspension.rs: velocity"]),
    eq("4", "mean axial projections", &["observable.rs: Projections"]),
    eq("5", "velocities normal to the contact line stay", &["collision.rs: share_velocity"]),
    eq("6", "velocities along the contact line become their mean", &["collision.rs: share_velocity"]),
    eq("7", "collision probability P_c", &["collision.rs: reach"]),
    eq("8", "P_c > R: collision", &["suspension.rs: find_candidates"]),
    eq("9", "P_c < R: no collision", &["suspension.rs: find_candidates"]),
    eq("10", "P_c with m = 3", &["collision.rs: reach", "scene.rs: m"]),
    eq("11", "Gaussian aspect ratios", &["rods.rs: draw_shapes"]),
    eq("12", "random positions and orientations", &["volume.rs: draw_positions", "orientation.rs: isotropic"]),
    eq("13", "orbit constant C", &["orientation.rs: bounded_orbit_constant"]),
    eq("14", "replacement of a rod that left", &["volume.rs: advance"]),
    eq("15", "period T", &["jeffery.rs: strain_per_period"]),
    eq("16", "steady mean projections", &["observable.rs: Projections"]),
    eq("17", "time mean of a projection", &["motion.rs: turned"]),
    eq("18", "mean angle over rods", &["observable.rs: MeanAngle", "orientation.rs: folded_phi"]),
    eq("19", "time mean of the angle", &["motion.rs: couette", "orientation.rs: folded_phi"]),
    eq("20", "angle of a single rod", &["motion.rs: couette"]),
    eq("21", "planar projections (text: θ for φ)", &["observable.rs: PlanarProjections"]),
    eq("A.1", "Jeffery's angular velocity", &["jeffery.rs: couette_rate", "motion.rs: Propagator"]),
    eq("A.2", "φ̇ in plane Couette flow", &["jeffery.rs: couette_rate"]),
    eq("A.3", "θ̇ in plane Couette flow", &["jeffery.rs: couette_rate"]),
    eq("A.4", "φ(t)", &["motion.rs: turned"]),
    eq("A.5", "θ(φ)", &["motion.rs: turned"]),
    eq("A.6", "period T", &["jeffery.rs: strain_per_period"]),
    eq("A.7", "velocity of a contact point", &["collision.rs: share_velocity", "suspension.rs: effect"]),
    eq("A.8", "its parts along and normal to the contact line", &["collision.rs: share_velocity"]),
    eq("A.9", "normal parts after the collision", &["collision.rs: share_velocity"]),
    eq("A.10", "parallel parts after the collision", &["collision.rs: share_velocity"]),
    eq("A.11", "contact velocity after the collision", &["collision.rs: share_velocity"]),
    eq("A.12", "the translation subtracted again", &["collision.rs: share_velocity"]),
    eq("A.13", "angle rates after the collision (corrected)", &["collision.rs: angle_rates"]),
    eq("A.14", "angles after the step", &["collision.rs: step_angles", "collision.rs: turn"]),
];

const fn eq(number: &'static str, says: &'static str, code: &'static [&'static str]) -> Equation {
    Equation { number, says, code }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases;
    use crate::judge::case::About;
    use std::collections::BTreeSet;
    use std::path::{Path, PathBuf};

    #[test]
    fn the_paper_s_equations_are_all_there_once() {
        let expected = (1..=21).map(|k| k.to_string()).chain((1..=14).map(|k| format!("A.{k}")));
        assert!(expected.eq(ALL.iter().map(|equation| equation.number.to_owned())));
    }

    #[test]
    fn every_equation_has_a_case_and_every_number_is_an_equation() {
        let numbers: BTreeSet<_> = ALL.iter().map(|equation| equation.number.to_owned()).collect();
        let tested: BTreeSet<_> = cases::all().into_iter().flat_map(|case| case.about.equations).collect();
        let untested: Vec<_> = numbers.difference(&tested).collect();
        let unknown: Vec<_> = tested.difference(&numbers).collect();
        assert!(untested.is_empty(), "equations without a case: {untested:?}");
        assert!(unknown.is_empty(), "no such equations: {unknown:?}");
    }

    #[test]
    fn no_case_is_there_twice_and_none_names_an_equation_twice() {
        let mut names = BTreeSet::new();
        for case in cases::all() {
            assert!(names.insert(case.about.name), "{} is there twice", case.about.name);
            let About { name, source, equations, .. } = case.about;
            let once: BTreeSet<_> = equations.iter().collect();
            assert_eq!(once.len(), equations.len(), "{name}");
            let named = source.starts_with("eq") || source.starts_with("A.");
            assert_eq!(named, !equations.is_empty(), "{name}: {source}: only equations before the first `;`");
        }
    }

    fn core(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { core(&path, files) } else { files.push(path) }
        }
    }

    #[test]
    fn the_code_it_points_to_is_there() {
        let mut files = Vec::new();
        core(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../src"), &mut files);
        let defines = |module: &str, item: &str| {
            let of_module = |path: &&PathBuf| {
                path.components().any(|part| Path::new(&part).file_stem().is_some_and(|stem| stem == module))
            };
            files.iter().filter(of_module).any(|path| {
                let text = std::fs::read_to_string(path).unwrap();
                let starts = [
                    format!("fn {item}("),
                    format!("fn {item}<"),
                    format!("pub {item}:"),
                    // A row of a table of keys or of observables.
                    format!("\n        {item}: "),
                    format!("\n    {item}: "),
                    format!("enum {item} "),
                    format!("struct {item}"),
                    format!("    {item},\n"),
                ];
                starts.iter().any(|start| text.contains(start))
            })
        };
        for equation in ALL {
            for place in equation.code {
                let (module, item) = place.split_once(".rs: ").expect("file.rs: item");
                assert!(defines(module, item), "{}: {place}", equation.number);
            }
        }
        assert!(!defines("jeffery", "no_such_item") && !defines("no_such_file", "rate"));
    }
}
