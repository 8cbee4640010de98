//! Tests that counts add up.

use super::*;

#[test]
fn counts_of_two_runs_are_added_one_by_one() {
    let one = Counters {
        steps: 1,
        draws: 2,
        pairs_screened: 3,
        cells: 4,
        distances: 5,
        candidates: 6,
        collisions: 7,
        replacements: 8,
        directions: 9,
        aspect_ratios_redrawn: 10,
        lengths_redrawn: 11,
    };
    let mut sum = one;
    sum.add(&one);
    sum.add(&one);
    let thrice = Counters {
        steps: 3,
        draws: 6,
        pairs_screened: 9,
        cells: 12,
        distances: 15,
        candidates: 18,
        collisions: 21,
        replacements: 24,
        directions: 27,
        aspect_ratios_redrawn: 30,
        lengths_redrawn: 33,
    };
    assert_eq!(sum, thrice);
}
