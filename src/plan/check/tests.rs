//! Tests the checks of shapes and starts at both sides of each limit.

use crate::model::shape::Correlation;
use crate::scene::{Error, Interaction, OwnRods, RodsFile, Scene};

fn refusal(scene: &Scene) -> String {
    crate::Plan::new(scene).expect_err("it is refused").to_string()
}

/// The limit is where 3σ reaches 1, or 0 for discs.
#[test]
fn the_widest_spread_is_told_and_a_little_less_is_taken() {
    for (mean, widest) in [(4.0, 25.0), (1.5, 100.0 / 9.0), (0.25, 100.0 / 3.0), (0.8, 25.0 / 3.0)] {
        let mut scene = Scene::default();
        scene.particles.aspect_ratio = mean;
        for (share, taken) in [(0.999, true), (1.001, false)] {
            scene.particles.aspect_ratio_sd_percent = widest * share;
            assert_eq!(crate::Plan::new(&scene).is_ok(), taken, "{mean}: {share}");
        }
        let expected = format!("a number below {widest:.4} with a mean of {mean}: with more,");
        assert!(refusal(&scene).contains(&expected), "{}", refusal(&scene));
    }
    let mut scene = Scene::default();
    scene.particles.aspect_ratio = 4.0;
    scene.particles.aspect_ratio_sd_percent = 25.0;
    assert!(crate::Plan::new(&scene).is_err(), "the limit itself");
}

#[test]
fn an_aspect_ratio_beside_a_cylinder_is_the_one_that_its_formula_makes() {
    let mut scene = Scene::default();
    scene.particles.physical_aspect_ratio = Some(20.0);
    scene.particles.shape_correlation = Some(Correlation::Cox);
    let made = Correlation::Cox.formula().equivalent(20.0).unwrap();
    scene.particles.aspect_ratio = made;
    assert!(crate::Plan::new(&scene).is_ok());
    scene.particles.aspect_ratio = made.next_up();
    assert!(refusal(&scene).contains(&format!("Cox 1971 makes {made}")), "{}", refusal(&scene));
}

#[test]
fn a_stress_in_pa_needs_a_viscosity_and_a_concentration() {
    let mut scene = Scene::default();
    scene.output.observables = vec![crate::Observable::Stress];
    assert!(refusal(&scene).contains("liquid.viscosity_pa_s"), "{}", refusal(&scene));
    scene.liquid.viscosity_pa_s = Some(2.0);
    assert!(refusal(&scene).contains("interaction.concentration_per_cm3"), "{}", refusal(&scene));
    scene.interaction = Some(Interaction { alpha: 0.0, ..Interaction::default() });
    assert!(crate::Plan::new(&scene).is_ok());
    for viscosity_pa_s in [1e-295, 1e295] {
        let mut scene = scene.clone();
        scene.liquid.viscosity_pa_s = Some(viscosity_pa_s);
        assert!(refusal(&scene).contains("Pa, is from 1e-290 to 1e290 Pa"), "{}", refusal(&scene));
    }
    // Each rod counts by its own length.
    scene.particles.length_sd_percent = 10.0;
    assert!(crate::Plan::new(&scene).unwrap().runs(crate::plan::Stage::Lengths));
    // The viscosity survives serialisation; an empty table is not written.
    let written = serde_json::to_value(&scene).unwrap();
    assert_eq!(serde_json::from_value::<Scene>(written).unwrap(), scene);
    scene.liquid.viscosity_pa_s = None;
    assert!(serde_json::to_value(&scene).unwrap().get("liquid").is_none());
    scene.liquid.viscosity_pa_s = Some(2.0);
    let gradient_per_s = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0; 3]];
    scene.flow = crate::scene::Flow::Gradient { gradient_per_s };
    scene.time = crate::scene::Time::strain(1.0);
    assert!(refusal(&scene).contains("stress needs plane Couette flow"), "{}", refusal(&scene));
}

/// Two rods in 2 cm³: the side is H = 12.6 mm.
#[test]
fn rods_that_cannot_be_are_refused_by_number() {
    let sound = OwnRods {
        p: Some([vec![1.0, 0.0], vec![0.0, 1.0], vec![0.0; 2]]),
        aspect_ratio: Some(vec![2.0, 20.0]),
        length_mm: Some(vec![0.5, 1.0]),
        place_mm: Some([(); 3].map(|()| vec![0.0, 12.5])),
    };
    let mut scene = Scene {
        interaction: Some(Interaction { concentration_per_cm3: Some(1.0), ..Interaction::default() }),
        ..Scene::default()
    };
    scene.particles.count = 2;
    let mut judged = |own: OwnRods| {
        scene.particles.rods = Some(RodsFile::with("two.csv", own));
        crate::Plan::new(&scene).map(|_| ()).map_err(|invalid| invalid.to_string())
    };
    assert_eq!(judged(sound.clone()), Ok(()));
    let with = |change: &dyn Fn(&mut OwnRods)| {
        let mut own = sound.clone();
        change(&mut own);
        own
    };
    for (own, why) in [
        (
            with(&|own| own.aspect_ratio = Some(vec![2.0, 1.0])),
            "rod 1 has aspect_ratio = 1.0; allowed: a number > 1, up to 1e100, for interacting rods",
        ),
        (with(&|own| own.aspect_ratio = Some(vec![f64::NAN, 2.0])), "rod 0 has aspect_ratio = NaN; allowed: "),
        (
            with(&|own| own.length_mm = Some(vec![1.0, 0.0])),
            "rod 1 has length_mm = 0.0; allowed: a number between 1e-50 and 1e50 times the scene's length_mm",
        ),
        (with(&|own| own.length_mm = Some(vec![f64::INFINITY, 1.0])), "rod 0 has length_mm = inf; allowed: "),
        (with(&|own| own.length_mm = Some(vec![1.0; 3])), "it has 3, and particles.count is 2"),
        (with(&|own| own.place_mm.as_mut().unwrap()[1][0] = 12.7), "rod 0 has x2_mm = 12.7; allowed: 0 to 12.599"),
        (with(&|own| own.place_mm.as_mut().unwrap()[2][1] = -1e-9), "; allowed: 0 to 12.599"),
        (with(&|own| own.place_mm.as_mut().unwrap()[0][1] = f64::NAN), "; allowed: 0 to 12.599"),
    ] {
        let refusal = judged(own).unwrap_err();
        assert!(refusal.starts_with("particles.rods = { file = \"two.csv\" } is not allowed: "), "{refusal}");
        assert!(refusal.contains(why), "{refusal}");
    }
}

#[test]
fn a_start_has_length_1_to_a_few_roundings() {
    let start = |length: f64| -> Result<(), Error> {
        let mut scene = Scene::default();
        scene.particles.count = 2;
        let own = OwnRods { p: Some([vec![1.0, 0.0], vec![0.0, length], vec![0.0; 2]]), ..OwnRods::default() };
        scene.particles.rods = Some(RodsFile::with("two.csv", own));
        crate::Plan::new(&scene).map(|_| ())
    };
    for length in [1.0, 1.0 + 4.0 * f64::EPSILON, 1.0 - 4.0 * f64::EPSILON] {
        assert_eq!(start(length), Ok(()), "{length}");
    }
    for length in [1.0 + 1e-14, 1.0 - 1e-14, 0.0, 2.0, f64::NAN] {
        let refusal = start(length).unwrap_err().to_string();
        assert!(refusal.contains("rod 1 has p1² + p2² + p3² = "), "{length}: {refusal}");
    }
}

/// The rods' volume over that of the box is the given fraction, whatever their sizes.
#[test]
fn a_volume_fraction_is_the_volume_of_spheroids_over_that_of_the_box() {
    let scene = |change: fn(&mut Scene)| {
        let mut scene = Scene::default();
        scene.particles.count = 4;
        scene.particles.volume_fraction = Some(0.002);
        scene.interaction = Some(Interaction { concentration_per_cm3: None, ..Interaction::default() });
        change(&mut scene);
        scene
    };
    let lengths = [0.3, 0.5, 0.72, 1.36];
    let of_file = |scene: &mut Scene| {
        let own = OwnRods {
            length_mm: Some(vec![0.3, 0.5, 0.72, 1.36]),
            aspect_ratio: Some(vec![5.0, 7.0, 20.0, 4.0]),
            ..OwnRods::default()
        };
        scene.particles.rods = Some(RodsFile::with("four.csv", own));
    };
    for (scene, cubes, r) in [
        (scene(|_| ()), 4.0 * 0.72f64.powi(3), 11.6),
        (scene(|scene| scene.particles.length_sd_percent = 20.0), 4.0 * 1.12 * 0.72f64.powi(3), 11.6),
        (scene(of_file), lengths.map(|a: f64| a.powi(3)).iter().sum(), 9.0),
    ] {
        let plan = crate::Plan::new(&scene).unwrap();
        let box_mm3: f64 = plan.scene().sides_mm().unwrap().iter().product();
        let rods_mm3 = std::f64::consts::PI / 6.0 * cubes / (r * r);
        assert!((rods_mm3 / box_mm3 / 0.002 - 1.0).abs() < 1e-12, "{rods_mm3} in {box_mm3}");
        // The same n, given as such.
        let mut same = scene.clone();
        let n = same.concentration_per_cm3();
        same.particles.volume_fraction = None;
        same.interaction.as_mut().unwrap().concentration_per_cm3 = n;
        assert_eq!(same.sides_mm(), scene.sides_mm());
    }
    for (change, expected) in [
        (
            (|scene| scene.interaction = Some(Interaction::default())) as fn(&mut Scene),
            "particles.volume_fraction = 0.002 is not allowed: either it or interaction.concentration_per_cm3, \
                not both",
        ),
        (|scene| scene.interaction.as_mut().unwrap().box_mm = Some([9.0; 3]), "either it or interaction.box_mm"),
        (|scene| scene.interaction = None, "free rods fill no volume: give [interaction]"),
        (|scene| scene.particles.volume_fraction = Some(1.5), "expected a number from 1e-100 to 1e0"),
        (
            |scene| scene.particles.length_mm = 1e-110,
            "particles.volume_fraction = 0.002 is not allowed: expected a number for which",
        ),
    ] {
        let found = refusal(&scene(change));
        assert!(found.contains(expected), "{found}");
    }
}
