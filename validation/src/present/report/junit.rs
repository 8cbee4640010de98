//! Writes junit.xml, with a test case for each case. A case without data is skipped.

use super::{CaseRow, Report};
use crate::files::text::escaped;
use crate::judge::accept::Verdict;

pub(super) fn write(report: &Report) -> String {
    let summary = &report.summary;
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"shearbed validate\" tests=\"{}\" \
         failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"{:.3}\" timestamp=\"{}\">\n",
        report.cases.len(),
        summary.fail + summary.underpowered,
        summary.nodata,
        summary.seconds,
        escaped(report.origin.date.trim_end_matches('Z'))
    );
    for row in &report.cases {
        xml += &format!(
            "<testcase classname=\"shearbed.{}\" name=\"{}\" time=\"{:.3}\">{}</testcase>\n",
            row.judges.tag(),
            escaped(&row.name),
            row.seconds,
            ended(row)
        );
    }
    xml + "</testsuite>\n</testsuites>\n"
}

/// The element that says why a case failed or was not judged; empty if it passed.
fn ended(row: &CaseRow) -> String {
    let words = escaped(&row.reasons());
    match row.verdict {
        Verdict::Pass => String::new(),
        Verdict::NoData => format!("<skipped message=\"no data\">{words}</skipped>"),
        Verdict::Fail => format!("<failure message=\"failed\">{words}</failure>"),
        Verdict::Underpowered => format!("<failure message=\"under-powered\">{words}</failure>"),
    }
}
