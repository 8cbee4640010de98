//! Points of free rods simulated at their own r_e, between the nodes, and the error of a fit to them. Free rods start
//! alike in every replica, so that hardly any noise remains.

use super::*;
use nalgebra::{DMatrix, DVector};

const RANGE: &str = "particles.aspect_ratio=11.1:11.6";
/// The rods' r_e, and its place between the ends of the range, −1 and 1.
const OWN: f64 = 11.43;
const PLACE: f64 = 4.0 * (OWN - 11.1) - 1.0;
const REPLICAS: u64 = 120;
/// The allowed error of the polynomials in standard uncertainties, and the effect to detect beyond that.
const OFF: f64 = 0.1;
const EFFECT: f64 = 0.3;

struct Simulated {
    basis: Basis,
    /// For each replica: the coefficients at every node, then the points at [`OWN`].
    at_nodes: Vec<Coefficients>,
    at_own: Vec<DVector<f64>>,
    /// Maps errors of the points to the error of r_e, in its standard uncertainties.
    influence: DMatrix<f64>,
}

static SIMULATED: Shared<(), Result<Arc<Simulated>, String>> = Shared::new();

fn simulated(effort: &Effort) -> Result<Arc<Simulated>, String> {
    let range = Range::parse(RANGE)?;
    let scene = Scene { time: Time::periods(1.6), ..lab::free_scene(effort) };
    let scenes = Scenes::new(vec![set(&scene, effort.seed(72), TimeColumn::Strain)?], vec![range.clone()])?;
    let mut points = data(|_| f64::NAN);
    for point in &mut points {
        point.time *= strain_per_period(OWN);
    }
    let places = points.clone();
    let basis = Basis::new(1);
    let model = |values: &[f64]| scenes.model(&places, AS_WRITTEN, values).map_err(String::from);
    let value = |node: &[f64]| vec![11.35 + 0.25 * node[0]];
    let at_nodes = coefficients(&basis, &model, &value, 0..REPLICAS, &|| ())?;
    let own = model(&[OWN])?;
    let at_own = |replica| Ok(DVector::from_iterator(POINTS, own.run(replica)?.iter().map(|point| point[0])));
    let at_own = (0..REPLICAS).map(at_own).collect::<Result<_, String>>()?;
    let curve = Emulator::new(&basis, &at_nodes).at(&[PLACE]);
    for (point, value) in points.iter_mut().zip(curve.iter()) {
        point.value = *value;
    }
    let fit = fit(&points, &range, &Rods::none(1), &basis, &at_nodes)?;
    let uncertainty = fit.best.covariance()[(0, 0)].sqrt();
    Ok(Arc::new(Simulated { influence: &fit.best.influence / uncertainty, basis, at_nodes, at_own }))
}

/// The error of r_e from such points, over the replicas; straight lines between the nodes are a mistake.
pub fn off(straight: bool, effort: &Effort) -> Result<Evidence, String> {
    let simulated = Result::clone(&SIMULATED.get(effort, (), || simulated(effort)))?;
    let mut terms = simulated.basis.terms(&[PLACE]);
    if straight {
        terms.rows_mut(2, 3).fill(0.0);
    }
    let off = |(own, at_nodes): (&DVector<f64>, &Coefficients)| {
        (&simulated.influence * (own - at_nodes[0].tr_mul(&terms)))[0]
    };
    Ok(Evidence::on("r_e of points simulated at that r_e itself, less it", "standard uncertainties")
        .is(Sample::of(simulated.at_own.iter().zip(&simulated.at_nodes).map(off)), 0.0, OFF, EFFECT)
        .because(
            "a tenth costs a 68 % interval 0.3 % of its share; straight lines between the nodes are off by more than \
             the effect",
        ))
}
