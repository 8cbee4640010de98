//! What is to be said of each program.

/// A program, its verdict, and words in the note on the first problem or in the remarks.
pub type Case<'a> = (&'a str, &'a str, &'a [&'a str]);

/// Said of methods of first order.
pub const EXTRAPOLATED: &[&str] = &["converges to the certified answer at order"];

/// Programs on the problem of a flow that turns; the last does not know of such flows.
pub const TURNING: &[Case] = &[
    ("turns", "PASS", &[]),
    ("turns_for_the_same_time", "FAIL", &["asked up to t = "]),
    ("turns_one_question_late", "FAIL", &["asked the same twice, with "]),
    ("turns_by_steps", "FAIL", &["L(t) taken at the start of each step, where any method is of order 1"]),
    ("turns_at_first", "FAIL", &["the curve of L(t) taken at t = 0 for ever"]),
    ("turns_without_spin", "FAIL", &["the curve of L(t) without the spin Q̇Qᵀ"]),
    ("turns_with_the_spin_reversed", "FAIL", &["the curve of L(t) with −Q̇Qᵀ for Q̇Qᵀ"]),
    ("turns_back", "FAIL", &["the curve of the rotation of the flow with the wrong sign"]),
    ("is_right", "FAIL", &["the curve of a flow that does not turn (rotation_rad_per_s left out)"]),
];

pub const CASES: &[Case] = &[
    ("is_right", "PASS", &[]),
    ("is_right_on_one_line_of_stderr_each", "PASS", &[]),
    ("ends_after_a_right_answer", "FAIL", &["the program ended: exit status: 4"]),
    ("cuts_its_steps", "FAIL", &["one step too few", "asked up to t = "]),
    ("is_off_by_1e-8", "FAIL", &["it is off by 1.0e-8"]),
    ("floods_stderr", "PASS", &[]),
    ("stays", "PASS", &["did not end within 5 s of the end of its input"]),
    ("says_more_at_the_end", "PASS", &["answers nothing: `bye`"]),
    ("is_random_within_the_tolerance", "FAIL", &["asked the same twice, with "]),
    ("is_garbage_every_third_time", "FAIL", &["does not jump"]),
    ("is_garbage_below_256_steps", "FAIL", &["with 255 steps it is off by", "with 256 by"]),
    ("answers_the_next_in_advance", "FAIL", &["line 4 of standard output"]),
    ("has_an_id_twice", "FAIL", &["line 3 of standard output", "duplicate field `id`"]),
    // On a busy machine time runs out before it hangs.
    ("hangs", "NOT REACHED", &[]),
    ("hangs_at_once", "NOT REACHED", &["no answer within 3 s", "given up: 2 answers did not come in time"]),
    ("never_reads", "NOT REACHED", &["no answer within 3 s"]),
    ("hangs_with_a_child", "NOT REACHED", &["no answer within 3 s"]),
    #[cfg(target_os = "linux")]
    ("hangs_in_the_group_of_shearbed", "NOT REACHED", &["no answer within 3 s"]),
    #[cfg(target_os = "linux")]
    ("hangs_with_daemons", "NOT REACHED", &["no answer within 3 s"]),
    #[cfg(target_os = "linux")]
    ("leaves_a_daemon", "PASS", &[]),
    ("ends", "FAIL", &["the program ended: exit status: 3", "last words", "out of ideas"]),
    ("aborts", "FAIL", &["the program ended: signal"]),
    ("closes_its_output", "FAIL", &["closed its standard output and went on"]),
    ("prints_junk", "FAIL", &["line 3 of standard output: not JSON", "`step 1 of 10`"]),
    ("answers_nan", "FAIL", &["not finite"]),
    ("forgets_a_rod", "FAIL", &["rods where"]),
    ("answers_out_of_order", "FAIL", &["line 3 of standard output: it answers id"]),
    ("answers_twice", "FAIL", &["line 2 of standard output"]),
    ("floods_stdout_with_lines", "FAIL", &["line 2 of standard output"]),
    ("floods_stdout_without_lines", "FAIL", &["is longer than 1048576 bytes"]),
    ("only_has_errors", "REFUSED", &["the program says: not today"]),
    ("transposes", "FAIL", &["the curve of a transposed gradient", "no longer change the answer"]),
];
