//! Every rod of a run at the times that its scene requests: a table, and lines for ParaView.

use shearbed::nalgebra::Vector3;
use shearbed::plan::Elapsed;
use shearbed::suspension::snapshot::Snapshot;
use shearbed::{Plan, Results, Scene};
use shearbed_validation::files::output::Output;
use std::fmt::Write;

/// The columns of `rods.csv`.
const COLUMNS: &str = "replica,rod,time_s,strain,aspect_ratio,length_mm,x1_mm,x2_mm,x3_mm,p1,p2,p3,collided\n";

/// The largest number of bytes of a row: ten numbers of 24 letters with their comma, replica and rod of 8 and 9 and a
/// digit.
const ROW: u64 = 10 * 24 + 9 + 10 + 2;

/// The largest number of bytes of a rod in a `.vtp` file: three vectors of three numbers (two ends and a direction),
/// its r_e and length, whether it collided, its replica, and the four places at which its line's ends are counted.
const LINE: u64 = 11 * 24 + 2 + 9 + 4 * 11;

/// The largest number of bytes of the files with every rod.
pub(super) fn most_bytes(plan: &Plan, vtk: bool) -> u64 {
    let of_rod = ROW + if vtk { LINE } else { 0 };
    plan.rods_out().saturating_mul(of_rod)
}

/// `rods.csv`, and with `vtk` also `rods.pvd` and the file of each time that it names. Empty if the scene requests no
/// rods.
pub(super) fn files(plan: &Plan, results: &Results, vtk: bool) -> Vec<Output> {
    let outputs = plan.rods_outputs();
    if outputs.is_empty() {
        return Vec::new();
    }
    let scene = plan.scene();
    let mut files = vec![("rods.csv".to_owned(), csv(results, scene))];
    if vtk {
        let mut parts: Vec<_> = results.snapshots.iter().collect();
        parts.sort_by_key(|snapshot| (snapshot.output, snapshot.replica));
        let one = scene.ensemble.replicas == 1;
        let name = |snapshot: &Snapshot| {
            let k = outputs.partition_point(|output| *output < snapshot.output);
            let replica = if one { String::new() } else { format!("_replica_{}", snapshot.replica) };
            format!("rods_{k:04}{replica}.vtp")
        };
        let line = |snapshot: &&Snapshot| {
            let time_s = results.elapsed[snapshot.output].seconds;
            (name(snapshot), time_s, snapshot.replica)
        };
        files.push(("rods.pvd".to_owned(), collection(parts.iter().map(line))));
        files.extend(parts.iter().map(|snapshot| (name(snapshot), polydata(snapshot, scene))));
    }
    files
}

/// A row for each rod; the cells of a free rod's place are empty. Numbers read back as the same bits.
fn csv(results: &Results, scene: &Scene) -> String {
    let mut text = COLUMNS.to_owned();
    for snapshot in &results.snapshots {
        let Elapsed { seconds: time_s, strain } = results.elapsed[snapshot.output];
        for rod in 0..snapshot.aspect_ratio.len() {
            let place = snapshot.place_mm(scene, rod).map_or(",,".to_owned(), numbers);
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{},{rod},{time_s:?},{strain:?},{:?},{:?},{place},{},{}",
                snapshot.replica,
                snapshot.aspect_ratio[rod],
                snapshot.length_mm(scene, rod),
                numbers(direction(snapshot, rod).into()),
                u8::from(snapshot.collided[rod]),
            );
        }
    }
    text
}

fn numbers([x1, x2, x3]: [f64; 3]) -> String {
    format!("{x1:?},{x2:?},{x3:?}")
}

fn direction(snapshot: &Snapshot, rod: usize) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| snapshot.p[axis][rod])
}

/// The rods of one replica at one time as VTK's XML PolyData: a line for each rod from end to end, in mm. Free rods
/// cross at the origin.
fn polydata(snapshot: &Snapshot, scene: &Scene) -> String {
    let count = snapshot.aspect_ratio.len();
    let array = |kind: &str, name: &str, components: usize, values: String| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">\n\
             {values}</DataArray>\n"
        )
    };
    let vector = |v: Vector3<f64>| format!("{:?} {:?} {:?}\n", v.x, v.y, v.z);
    let of_each = |value: &dyn Fn(usize) -> String| (0..count).map(value).collect::<String>();
    let ends = of_each(&|rod| {
        let centre = Vector3::from(snapshot.place_mm(scene, rod).unwrap_or_default());
        let half = direction(snapshot, rod) * (0.5 * snapshot.length_mm(scene, rod));
        vector(centre - half) + &vector(centre + half)
    });
    let ends_of_lines: String = (0..count).map(|k| format!("{} {}\n", 2 * k, 2 * k + 1)).collect();
    let offsets: String = (1..=count).map(|k| format!("{}\n", 2 * k)).collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{count}\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"0\">\n<CellData Vectors=\"p\">\n{}{}{}{}{}</CellData>\n<Points>\n{}</Points>\n<Lines>\n{}{}\
         </Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n",
        2 * count,
        array("Float64", "p", 3, of_each(&|rod| vector(direction(snapshot, rod)))),
        array("Float64", "aspect_ratio", 1, of_each(&|rod| format!("{:?}\n", snapshot.aspect_ratio[rod]))),
        array("Float64", "length_mm", 1, of_each(&|rod| format!("{:?}\n", snapshot.length_mm(scene, rod)))),
        array("UInt8", "collided", 1, of_each(&|rod| format!("{}\n", u8::from(snapshot.collided[rod])))),
        array("Int64", "replica", 1, of_each(&|_| format!("{}\n", snapshot.replica))),
        array("Float64", "ends_mm", 3, ends),
        array("Int64", "connectivity", 1, ends_of_lines),
        array("Int64", "offsets", 1, offsets),
    )
}

/// A ParaView collection of files with their times in s and their replicas.
fn collection(parts: impl Iterator<Item = (String, f64, u64)>) -> String {
    let line = |(name, time_s, replica): (String, f64, u64)| {
        format!("<DataSet timestep=\"{time_s:?}\" part=\"{replica}\" file=\"{name}\"/>\n")
    };
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n{}</Collection>\n\
         </VTKFile>\n",
        parts.map(line).collect::<String>()
    )
}
