use super::*;
use crate::scene;

fn plan(count: usize, replicas: u64) -> Plan {
    let text = format!(
        "title = \"t\"\n[flow]\nshear_rate_per_s = 1\n[particles]\ncount = {count}\nlength_mm = 1\n\
         aspect_ratio = 5\norientation = \"isotropic\"\n[time]\nperiods = 2\noutputs_per_period = 4\n\
         [ensemble]\nreplicas = {replicas}\nseed = 7\n[output]\n\
         observables = [\"projections\", \"orbit_constant\", \"orientation_tensor\"]\n"
    );
    Plan::new(&scene::parse("s.toml", &text).unwrap()).unwrap()
}

fn recorder<'a>(plan: &'a Plan, replica: u64, observables: &'a [Observable]) -> Recorder<'a> {
    Recorder::new(plan, replica, observables.iter().map(|observable| &**observable).collect(), Sum::none(false))
}

/// Runs a replica in which the rod `rod` points along `wrong` at the output `at`.
fn broken(count: usize, rod: usize, at: usize, wrong: [f64; 3]) -> Result<(), Error> {
    let plan = plan(count, 2);
    let (rods, _) = Rods::draw(&plan, 1);
    recorder(&plan, 1, &plan.observables()).record(0..plan.outputs(), &rods, |first, output, selected| {
        rods.orient(first, output as u64, selected)?;
        let block = &mut selected.block;
        if output == at && (first..first + block.len).contains(&rod) {
            (0..3).for_each(|axis| block.p[axis][rod - first] = wrong[axis]);
        }
        Ok(())
    })
}

#[test]
fn a_broken_propagation_stops_the_run_and_names_rod_output_and_replica() {
    // Rods in the first block and in the last, on one thread and on many.
    for (count, rod) in [(300, 0), (300, 299), (1, 0), (CHUNK + 200, CHUNK + 131)] {
        assert_eq!(broken(count, rod, 5, [0.6, 0.0, 0.8]), Ok(()));
        for wrong in [[0.0; 3], [f64::NAN; 3], [0.6, 0.8, 0.1]] {
            let error = broken(count, rod, 5, wrong).unwrap_err();
            let start = format!("rod {rod}, output 5 (t_over_T = 1.25) of replica 1, seed 7: its direction");
            assert!(error.to_string().starts_with(&start), "{error}");
            assert!(error.to_string().contains("r_e = 5"), "{error}");
        }
    }
}

#[test]
fn of_several_wrong_rods_the_first_is_named_whatever_the_threads() {
    let plan = plan(3 * CHUNK, 1);
    let (rods, _) = Rods::draw(&plan, 0);
    let record = |_| recorder(&plan, 0, &plan.observables()).record(0..1, &rods, |_, _, _| Ok(())).unwrap_err();
    let errors: Vec<_> = (0..4).map(record).collect();
    assert!(errors.iter().all(|error| *error == errors[0]));
    assert!(errors[0].to_string().starts_with("rod 0, output 0 "), "{}", errors[0]);
}

/// Aspect ratios and weights are those of the block's own rods, also beyond the first block.
#[test]
fn every_block_has_its_own_rods() {
    let mut scene = plan(300, 1).scene().clone();
    (scene.particles.aspect_ratio_sd_percent, scene.particles.length_sd_percent) = (5.0, 30.0);
    scene.output.observables = vec![Observable::ParticleStress];
    let plan = Plan::new(&scene).unwrap();
    let (rods, _) = Rods::draw(&plan, 0);
    let cubes: Vec<_> = rods.lengths().iter().map(|length| length.powi(3)).collect();
    let mean = cubes.iter().sum::<f64>() / 300.0;
    let mut selected = Selected::default();
    let mut seen = 0;
    for first in (0..300).step_by(BLOCK) {
        rods.select(first, &mut selected);
        let block = &selected.block;
        for k in 0..block.len {
            assert_eq!(block.aspect_ratio[k], rods.aspect_ratio(first + k));
            assert!((block.weight[k] * mean / cubes[first + k] - 1.0).abs() < 1e-14, "{first} {k}");
        }
        seen += block.len;
    }
    assert_eq!(seen, 300);
}

/// σ₁₂, N₁ and N₂ in Pa at the start of the default scene with 300 rods, as altered by `change`.
fn stress_pa(change: impl Fn(&mut scene::Scene)) -> [f64; 3] {
    let mut scene = scene::Scene::default();
    scene.particles.count = 300;
    scene.liquid.viscosity_pa_s = Some(20.0);
    scene.interaction = Some(scene::Interaction { alpha: 0.0, ..scene::Interaction::default() });
    scene.output.observables = vec![Observable::Stress];
    change(&mut scene);
    let results = ensemble::run(&Plan::new(&scene).unwrap()).unwrap();
    ["s12_pa", "n1_pa", "n2_pa"].map(|name| results.column(name).unwrap().mean[0])
}

/// A mean over rods that count by their cubed lengths is a quotient of sums: parallel rods of several lengths scatter
/// in no replica, and one replica cannot say so.
#[test]
fn one_replica_gives_no_error_of_a_weighted_mean() {
    let errors = |replicas: u64, sd_percent: f64| {
        let mut scene = plan(100, replicas).scene().clone();
        scene.particles.length_sd_percent = sd_percent;
        scene.particles.orientation = scene::Orientation::Given { phi_deg: 45.0, theta_deg: 90.0 };
        scene.output.observables = vec![Observable::ParticleStress, Observable::Projections];
        let plan = Plan::new(&scene).unwrap();
        let results = ensemble::run(&plan).unwrap();
        let of_caller = own::observe(&plan, &*Observable::ParticleStress).unwrap();
        let [stress, x1] = ["s12_per_mu_fiber_g", "x1"].map(|name| results.column(name).unwrap().se[0]);
        assert_eq!(of_caller[0].se[0].to_bits(), stress.to_bits());
        [stress, x1]
    };
    let [stress, x1] = errors(1, 30.0);
    assert!(stress.is_nan() && x1 < 1e-15, "{stress} {x1}");
    for (replicas, sd_percent) in [(2, 30.0), (1, 0.0)] {
        assert!(errors(replicas, sd_percent).iter().all(|se| *se < 1e-15));
    }
}

/// μ G n⟨a³⟩ in Pa for 50 bodies of 0.72 mm per cm³ at 0.5 1/s in 20 Pa s.
const UNIT_PA: f64 = 20.0 * 0.5 * 50.0 * 0.072 * 0.072 * 0.072;

/// Einstein: spheres have 2.5 μφG, in any direction, and also with several lengths, where ⟨a³⟩ = 1 + 3·0.3².
#[test]
fn spheres_have_einsteins_stress() {
    let einstein = 2.5 * std::f64::consts::PI / 6.0 * UNIT_PA;
    for (sd_percent, expected) in [(0.0, einstein), (30.0, 1.27 * einstein)] {
        for r_e in [1.0, 1.0 + 1e-9, 1.0 - 1e-9] {
            let [s12, n1, n2] = stress_pa(|scene| {
                scene.particles.aspect_ratio = r_e;
                scene.particles.length_sd_percent = sd_percent;
            });
            assert!((s12 / expected - 1.0).abs() < 1e-8, "{r_e}: {s12} {expected}");
            assert!(n1.abs() < 1e-8 && n2.abs() < 1e-8, "{r_e}: {n1} {n2}");
        }
    }
}

/// Along the vorticity axis a cylinder of length over diameter r has 2μφG, with φ = πna³/(4r²).
#[test]
fn a_cylinder_counts_by_its_own_aspect_ratio() {
    let [s12, n1, n2] = stress_pa(|scene::Scene { particles, .. }| {
        (particles.physical_aspect_ratio, particles.shape_correlation) =
            (Some(10.0), Some(crate::model::shape::Correlation::Zhang));
        particles.aspect_ratio = 7.612;
        particles.orientation = scene::Orientation::Given { phi_deg: 0.0, theta_deg: 0.0 };
    });
    assert!((s12 / (UNIT_PA * std::f64::consts::PI / 200.0) - 1.0).abs() < 1e-12, "{s12}");
    assert!(n1.abs() < 1e-12 && n2.abs() < 1e-12, "{n1} {n2}");
}

/// A unit of any size scales means and standard errors alike: over replicas, and over the rods of one.
#[test]
fn a_unit_changes_no_digit_of_a_standard_error() {
    for replicas in [1, 3] {
        let found = |viscosity_pa_s: f64, shear_rate_per_s: f64| {
            let mut scene = plan(50, replicas).scene().clone();
            scene.liquid.viscosity_pa_s = Some(viscosity_pa_s);
            let gradient_per_s = [[0.0; 3], [shear_rate_per_s, 0.0, 0.0], [0.0; 3]];
            scene.flow = scene::Flow::Gradient { gradient_per_s };
            scene.interaction = Some(scene::Interaction { alpha: 0.0, ..scene::Interaction::default() });
            scene.output.observables = vec![Observable::Stress];
            let results = ensemble::run(&Plan::new(&scene).unwrap()).unwrap();
            ["s12_pa", "n1_pa", "n2_pa"].map(|name| {
                let column = results.column(name).unwrap();
                (column.mean[1], column.se[1])
            })
        };
        // Powers of two, so that no digit changes.
        let one = found(1.0, 1.0);
        for power in [-900, 900] {
            let unit = 2f64.powi(power);
            let scaled = one.map(|(mean, se)| (mean * unit, se * unit));
            assert_eq!(found(unit, 1.0), scaled, "{replicas} {power}");
        }
        assert!(found(1.0, -1.0).iter().all(|(_, se)| *se > 0.0));
    }
}
