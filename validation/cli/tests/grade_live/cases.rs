//! What each program is to be told.

/// What a program does, and what is to be said of it.
pub struct Case {
    pub program: &'static str,
    pub verdict: &'static str,
    /// In the note on the first problem, or in the remarks.
    pub words: &'static [&'static str],
}

pub const CASES: &[Case] = &[
    Case { program: "is_right", verdict: "PASS", words: &[] },
    Case { program: "rk_2", verdict: "PASS", words: &[] },
    Case { program: "rk_2_normalised", verdict: "PASS", words: &[] },
    Case { program: "rk_3", verdict: "PASS", words: &[] },
    Case { program: "rk_3_normalised", verdict: "PASS", words: &[] },
    Case { program: "rk_4", verdict: "PASS", words: &[] },
    Case { program: "rk_4_normalised", verdict: "PASS", words: &[] },
    Case { program: "rk_5", verdict: "PASS", words: &[] },
    Case { program: "rk_5_normalised", verdict: "PASS", words: &[] },
    Case { program: "rk_6", verdict: "PASS", words: &[] },
    Case { program: "rk_6_normalised", verdict: "PASS", words: &[] },
    Case { program: "rk_7", verdict: "PASS", words: &[] },
    Case { program: "rk_7_normalised", verdict: "PASS", words: &[] },
    Case { program: "rk_8", verdict: "PASS", words: &[] },
    Case { program: "rk_8_normalised", verdict: "PASS", words: &[] },
    Case { program: "rk_1_normalised", verdict: "PASS", words: &["converges to the certified answer at order"] },
    Case { program: "is_right_on_one_line_of_stderr_each", verdict: "PASS", words: &[] },
    Case { program: "ends_after_a_right_answer", verdict: "FAIL", words: &["the program ended: exit status: 4"] },
    Case { program: "is_off_by_1e-8", verdict: "FAIL", words: &["it is off by 1.0e-8"] },
    Case { program: "floods_stderr", verdict: "PASS", words: &[] },
    Case { program: "stays", verdict: "PASS", words: &["did not end within 5 s of the end of its input"] },
    Case { program: "says_more_at_the_end", verdict: "PASS", words: &["answers nothing: `bye`"] },
    Case { program: "is_garbage_every_third_time", verdict: "FAIL", words: &["does not jump"] },
    Case {
        program: "is_garbage_below_256_steps",
        verdict: "FAIL",
        words: &["with 255 steps it is off by", "with 256 by"],
    },
    Case { program: "answers_the_next_in_advance", verdict: "FAIL", words: &["line 4 of standard output"] },
    Case { program: "has_an_id_twice", verdict: "FAIL", words: &["line 3 of standard output", "duplicate field `id`"] },
    Case { program: "rk_1", verdict: "PASS", words: &["converges to the certified answer at order"] },
    // On a busy machine time runs out before it hangs.
    Case { program: "hangs", verdict: "NOT REACHED", words: &[] },
    Case {
        program: "hangs_at_once",
        verdict: "NOT REACHED",
        words: &["no answer within 1 s", "given up: 2 answers did not come in time"],
    },
    Case { program: "never_reads", verdict: "NOT REACHED", words: &["no answer within 1 s"] },
    Case { program: "hangs_with_a_child", verdict: "NOT REACHED", words: &["no answer within 1 s"] },
    #[cfg(target_os = "linux")]
    Case { program: "hangs_in_the_group_of_shearbed", verdict: "NOT REACHED", words: &["no answer within 1 s"] },
    #[cfg(target_os = "linux")]
    Case { program: "hangs_with_daemons", verdict: "NOT REACHED", words: &["no answer within 1 s"] },
    #[cfg(target_os = "linux")]
    Case { program: "leaves_a_daemon", verdict: "PASS", words: &[] },
    Case {
        program: "ends",
        verdict: "FAIL",
        words: &["the program ended: exit status: 3", "last words", "out of ideas"],
    },
    Case { program: "aborts", verdict: "FAIL", words: &["the program ended: signal"] },
    Case { program: "closes_its_output", verdict: "FAIL", words: &["closed its standard output and went on"] },
    Case { program: "prints_junk", verdict: "FAIL", words: &["line 3 of standard output: not JSON", "`step 1 of 10`"] },
    Case { program: "answers_nan", verdict: "FAIL", words: &["not finite"] },
    Case { program: "forgets_a_rod", verdict: "FAIL", words: &["rods where"] },
    Case { program: "answers_out_of_order", verdict: "FAIL", words: &["line 3 of standard output: it answers id"] },
    Case { program: "answers_twice", verdict: "FAIL", words: &["line 2 of standard output"] },
    Case { program: "floods_stdout_with_lines", verdict: "FAIL", words: &["line 2 of standard output"] },
    Case { program: "floods_stdout_without_lines", verdict: "FAIL", words: &["is longer than 1048576 bytes"] },
    Case { program: "only_has_errors", verdict: "REFUSED", words: &["steps the program says: not today"] },
    Case {
        program: "transposes",
        verdict: "FAIL",
        words: &["the curve of a transposed gradient", "no longer change the answer"],
    },
];
