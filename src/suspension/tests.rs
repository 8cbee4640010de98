//! States of one's own.

use super::*;

#[test]
fn a_state_of_other_counts_is_refused_and_changes_nothing() {
    let scene = r#"
title = "t"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 3
length_mm = 0.72
aspect_ratio = 11.6
orientation = "isotropic"
[interaction]
concentration_per_cm3 = 200
alpha = 0.5
[time]
periods = 1
"#;
    let plan = Plan::new(&crate::scene_file::parse("s.toml", scene).unwrap()).unwrap();
    let mut suspension = Suspension::new(&plan, 0).unwrap();
    let before = suspension.positions_in_lengths().clone();
    let places = |count| [(); 3].map(|()| vec![0.1; count]);
    let directions = |count| vec![Vector3::z_axis(); count];
    let mut uneven = places(3);
    uneven[2].pop();
    for (places, directions) in [
        (places(3), directions(2)),
        (places(2), directions(3)),
        (places(4), directions(4)),
        (uneven, directions(3)),
    ] {
        assert_eq!(suspension.place(places, &directions), None);
        assert_eq!(suspension.positions_in_lengths(), &before);
    }
    assert_eq!(suspension.place(places(3), &directions(3)), Some(()));
    assert_eq!(suspension.positions_in_lengths(), &places(3));
}
