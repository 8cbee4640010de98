use super::*;
use crate::serve::problems::loaded;

fn of(errors: &[f64]) -> Orders {
    let errors: Vec<_> = (0..).map(|k| 10u64 << k).zip(errors.iter().copied()).collect();
    orders(&errors, [1e-8; 2])
}

/// The orders of errors that fall from 0.01 by these orders.
fn falling(orders: &[f64]) -> Orders {
    let mut errors = vec![0.01];
    errors.extend(orders.iter().scan(0.01, |error, order| {
        *error *= 2f64.powf(-order);
        Some(*error)
    }));
    of(&errors)
}

#[test]
fn an_order_has_its_sign_and_needs_two_errors_above_round_off() {
    let observed = |errors: &[f64]| of(errors).observed(None).map(|order| (order * 1e6).round() / 1e6);
    assert_eq!(observed(&[1e-2, 1e-2 / 16.0, 1e-12]), Some(4.0));
    assert_eq!(observed(&[1e-3, 2e-3, 4e-3]), Some(-1.0), "it diverges");
    assert_eq!(observed(&[1e-3, 1e-12, 1e-3]), None);
    assert_eq!(observed(&[1e-12, 1e-13]), None);
    assert_eq!(observed(&[f64::NAN, 1e-3]), None);
    assert_eq!(observed(&[1e-3]), None);
    assert_eq!(observed(&[1.0, 0.5, 1e-3]), None, "it does not follow the motion yet");
    assert_eq!(observed(&[8e-9, 1e-9, 9e-10]), None, "it meets round-off below the tolerance");
    let uneven = orders(&[(100, 1e-2), (300, 1e-2 / 9.0)], [1e-9; 2]);
    assert!((uneven.observed(None).unwrap() - 2.0).abs() < 1e-12 && uneven.all.len() == 1);
}

/// Measured on right codes: Gauss of order 6 in angles, which wanders first, and a splitting of order 2 whose rounding
/// begins above the tolerance.
#[test]
fn right_codes_that_wander_first_or_meet_their_rounding_early_are_not_refuted() {
    let of = |errors: &[f64]| {
        let errors: Vec<_> = (0..).map(|k| 32u64 << k).zip(errors.iter().copied()).collect();
        orders(&errors, [5e-11; 2])
    };
    let gauss = [1.31e-1, 7.41e-2, 1.67e-3, 2.78e-3, 6.44e-5, 1.27e-6, 7.76e-9, 1.77e-10, 2.83e-12, 1.27e-13];
    assert_ne!(of(&gauss).judged(6.0), Order::Lower);
    assert_eq!(of(&gauss[..6]).judged(6.0), Order::Lower, "so far it lacks two orders");
    let splitting = [1.10e-6, 2.75e-7, 6.88e-8, 1.72e-8, 4.29e-9, 1.08e-9, 2.71e-10, 7.84e-11, 8.66e-11, 1.90e-10];
    assert_eq!(of(&splitting).judged(2.0), Order::Seen);
    // Errors that stay far above the tolerance are no rounding.
    let stays = splitting.map(|error| 100.0 * error);
    assert_ne!(of(&stays[..9]).judged(2.0), Order::Lower);
    assert_eq!(of(&[&stays[..9], &[1.9e-8, 3.8e-8, 7.6e-8]].concat()).judged(2.0), Order::Lower);
}

#[test]
fn what_right_methods_show_is_not_refuted_and_lost_orders_are() {
    for (orders, claimed, expected) in [
        (&[4.5, 4.3, 4.1, 4.05][..], 4.0, Order::Seen),
        // RK4 with p/|p| on the disc: only the mean counts.
        (&[5.57, 3.53], 4.0, Order::Unclear),
        (&[3.5, 3.53, 3.8], 4.0, Order::Unclear),
        (&[3.5, 3.6, 3.81], 4.0, Order::Seen),
        // Cash and Karp's: an error term that changes sign.
        (&[7.8, 3.2, 4.3], 5.0, Order::Seen),
        (&[2.5, 2.6], 3.0, Order::Unclear),
        (&[3.0], 3.0, Order::Seen),
        (&[1.0], 3.0, Order::Unclear),
        (&[4.0, 1.0, 1.0], 4.0, Order::Lower),
        (&[3.9, 3.1, 3.0, 3.0], 4.0, Order::Lower),
        (&[-1.0, -1.0], 4.0, Order::Lower),
        (&[4.0, 4.0], 3.0, Order::Higher),
        (&[5.9, 5.8, 5.6], 5.0, Order::Unclear),
        (&[3.25, 3.1], 4.0, Order::Unclear),
        (&[1.7, 2.3, 1.6, 2.4], 4.0, Order::Lower),
        (&[3.58, 0.42, 3.58, 0.42], 4.0, Order::Lower),
        (&[1.7, 2.3, 1.6, 3.9], 4.0, Order::Seen),
        // Rounding above the tolerance, after the order was seen: a rotation by angles without |p| = 1.
        (&[2.0, 2.0, 2.0, 2.0, 2.8, -1.2, -0.2, -0.6, 0.8], 2.0, Order::Seen),
        (&[3.0, 1.6, 0.4, 1.6, 0.4], 3.0, Order::Lower),
        // Down to 1e-10, a hundredth of the tolerance: round-off, and a method of order 7.
        (&[5.0, 5.0, 5.0, 5.0, 5.0, 1.0, 0.9], 5.0, Order::Seen),
        (&[7.0, 7.1, 7.0], 8.0, Order::Lower),
        (&[], 3.0, Order::Unclear),
    ] {
        assert_eq!(falling(orders).judged(claimed), expected, "{orders:?} {claimed}");
    }
    assert!(falling(&[1.0, 1.0, 1.05]).refuted_early(4.0));
    assert!(!falling(&[1.0, 1.0, 1.3]).refuted_early(4.0), "it rises");
    assert!(!falling(&[1.0, 1.0, 1.0]).refuted_early(1.0));
    assert!(!falling(&[3.3, 3.35, 3.4]).refuted_early(4.0), "before it has settled");
}

#[test]
fn a_claim_that_is_too_low_fails_where_no_problem_shows_it_and_none_explains_it() {
    let settled = |of: &[(&str, Order, Verdict)]| {
        let problems: Vec<_> = of.iter().map(|(name, ..)| loaded(name)).collect();
        let one = |(loaded, (_, order, verdict)): (&LoadedProblem, &(&str, Order, Verdict))| Graded {
            verdict: *verdict,
            order_found: Some(*order),
            observed_order: Some(5.0),
            ..Graded::without_answer(loaded)
        };
        let mut graded: Vec<_> = problems.iter().zip(of).map(one).collect();
        settle(&problems, &mut graded, Some(4.0));
        graded.into_iter().map(|graded| (graded.verdict, graded.note.unwrap_or_default())).collect::<Vec<_>>()
    };
    let (plane, space) = ("shear-plane", "spiral");
    let too_low = "observed order +5.00 where 4 is claimed";
    let no_error = "observed order +5.00, higher than the claimed 4: no fault";
    let none = String::new;
    assert_eq!(
        settled(&[(plane, Order::Higher, Verdict::Pass), (space, Order::Higher, Verdict::Pass)]),
        [(Verdict::Pass, no_error.into()), (Verdict::Fail, too_low.into())]
    );
    assert_eq!(
        settled(&[(space, Order::Higher, Verdict::Pass), (plane, Order::Seen, Verdict::Pass)]),
        [(Verdict::Pass, no_error.into()), (Verdict::Pass, none())]
    );
    assert_eq!(
        settled(&[(space, Order::Higher, Verdict::NotReached), (space, Order::Unclear, Verdict::Pass)]),
        [(Verdict::NotReached, none()), (Verdict::Pass, none())]
    );
    // Tensors have no rods in a plane.
    assert_eq!(settled(&[("closed-ft-linear-0.1", Order::Higher, Verdict::Pass)]), [(Verdict::Fail, too_low.into())]);
}

#[test]
fn right_answers_alone_are_said_to_have_an_unclear_order() {
    let of = |(name, order, verdict): (&str, Order, Verdict)| Graded {
        verdict,
        order_found: Some(order),
        ..Graded::without_answer(&loaded(name))
    };
    let graded = [
        ("shear-plane", Order::Seen, Verdict::Pass),
        ("spiral", Order::Unclear, Verdict::Pass),
        ("sphere", Order::Unclear, Verdict::Fail),
    ]
    .map(of);
    let said = remark(&graded, Some(4.0)).unwrap();
    assert!(said.starts_with("order 4 is seen on 1 of 3 problems; ") && said.ends_with(" wander, on spiral"), "{said}");
    // A formula has no steps.
    let formula = Graded { verdict: Verdict::Pass, ..Graded::without_answer(&loaded("pdot-rod")) };
    assert_eq!(remark(&[&graded[..], std::slice::from_ref(&formula)].concat(), Some(4.0)), Some(said));
    assert_eq!(remark(&[formula], Some(4.0)), None);
}

#[test]
fn it_is_said_why_no_order_is_judged_and_which_low_ones_pass() {
    let one = Graded { verdict: Verdict::Pass, ..Graded::without_answer(&loaded("spiral")) };
    let adaptive = Graded { asked_tolerance: Some(1e-6), ..one.clone() };
    let said = |graded: Graded| remark(&[graded], Some(4.0)).unwrap();
    assert_eq!(said(one.clone()), "no order is judged: one answer shows none");
    assert_eq!(said(adaptive), "no order is judged: the program chooses its own steps");
    let of_order = |order| Graded { observed_order: Some(order), ..one.clone() };
    let unclaimed = |order| remark(&[of_order(order)], None);
    assert!(unclaimed(1.02).unwrap().ends_with("passes too; observed: spiral (+1.02)"));
    assert_eq!(unclaimed(3.98), None);
    let wrong = Graded { verdict: Verdict::Fail, ..of_order(1.0) };
    assert_eq!(remark(&[wrong], None), None);
}

#[test]
fn an_error_that_stays_is_not_blamed_on_the_order() {
    let loaded = loaded("spiral");
    let said = |order: f64| {
        let graded = Graded { observed_order: Some(order), error: Some(3.1e-3), ..Graded::without_answer(&loaded) };
        other(&graded, 4.0)
    };
    for order in [0.0, 0.19, -0.19] {
        assert!(said(order).contains("the error stays at 3.1e-3 whatever the step"), "{}", said(order));
    }
    for order in [1.0, 0.3, -1.0] {
        assert!(!said(order).contains("stays"), "{}", said(order));
    }
}

#[test]
fn one_wild_answer_is_found_and_a_small_error_by_chance_is_none() {
    let outlier = |errors: &[f64]| {
        let errors: Vec<_> = (0..).map(|k| 100u64 << k).zip(errors.iter().copied()).collect();
        outlier(&errors, 1e-8)
    };
    let said = "off by 7.0e-1 with 400 steps, by 6.0e-4 with 200 and 2.5e-6 with 800: no method has such errors";
    assert_eq!(outlier(&[1e-2, 6e-4, 0.7, 2.5e-6]).as_deref(), Some(said));
    for wrong in [
        &[5e-3, 0.3, 2e-5, 1e-6][..],
        &[1e-4, f64::NAN, 1e-6],
        // Less than the coarsest error; the finest answer, after three and after two; between answers that do not
        // exist.
        &[9e-3, 6e-4, 4e-5, 1e-3, 1.5e-7],
        &[9e-3, 6e-4, 4e-5, 1e-2],
        &[1e-4, 6e-6, 0.05],
        &[9e-3, f64::NAN, 4e-5, f64::NAN, 1.5e-7],
    ] {
        assert!(outlier(wrong).is_some(), "{wrong:?}");
    }
    assert_eq!(
        outlier(&[1e-3, 6e-5, 4e-6, 0.09]).as_deref(),
        Some("off by 9.0e-2 with 800 steps, by 4.0e-6 with 400: no method has such errors")
    );
    for right in [
        &[1e-2, 6e-4, 4e-5, 2.5e-6][..],
        // An error term that changes sign, at order 4 and at order 8.
        &[1e-2, 1e-7, 4e-5, 2.5e-6],
        &[1e-7, 4e-5, 2.5e-6],
        &[1e-9, 1e-3, 4e-6],
        // It does not follow the motion yet, or it has met round-off.
        &[0.05, 1.5, 2e-3, 1e-4],
        &[1e-2, 6e-4, 1e-12, 1e-10, 1e-12],
        &[1e-3, 1.0],
        // The finest but one, or the two before it, small by chance.
        &[1e-2, 6e-4, 1e-9, 2.5e-6],
        &[1e-2, 1e-9, 4e-5, 2.5e-6],
        &[],
    ] {
        assert_eq!(outlier(right), None, "{right:?}");
    }
}

#[test]
fn of_two_orders_the_nearer_to_the_claim_is_named() {
    let found = falling(&[3.0, 4.0, 4.4]);
    assert!((found.observed(Some(4.0)).unwrap() - 4.0).abs() < 1e-9);
    assert!((found.observed(None).unwrap() - 4.4).abs() < 1e-9);
    let found = falling(&[3.0, 4.4, 4.0]);
    assert!((found.observed(Some(4.0)).unwrap() - 4.0).abs() < 1e-9);
}

/// Single precision: an error that stays at 1e-6 proves nothing where 1e-4 is allowed, and a lost order still does.
#[test]
fn a_plateau_below_the_tolerance_refutes_nothing() {
    let errors = |errors: &[f64]| (0..).map(|k| 10u64 << k).zip(errors.iter().copied()).collect::<Vec<_>>();
    let plateau = errors(&[8e-3, 5e-4, 3.1e-5, 2e-6, 1.2e-6, 1.25e-6, 1.2e-6]);
    assert_eq!(orders(&plateau, [1e-9, 1e-4]).judged(4.0), Order::Seen);
    assert_eq!(orders(&plateau, [1e-9; 2]).judged(4.0), Order::Lower);
    let first = errors(&[8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4, 1.2e-4, 6e-5, 3e-5]);
    assert_eq!(orders(&first, [1e-9, 1e-4]).judged(4.0), Order::Lower);
}
