//! The checkpoint of `validate` and `bench`: their finished cases and studies.

use super::{Failure, Writing};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use shearbed_validation::files::checkpoint::{Checkpoint, on_stop};
use shearbed_validation::judge::accept::Verdict;
use shearbed_validation::judge::case::{Control, Judged};
use shearbed_validation::present::study::Findings;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Verdict, evidence, controls and seconds of a case.
pub(super) type CaseResult = (Verdict, Vec<Judged>, Vec<Control>, f64);

/// The findings of a study and its seconds.
pub(super) type Measured = (Findings, f64);

/// Cases and studies by name.
#[derive(Default, Serialize, Deserialize)]
struct State {
    cases: BTreeMap<String, CaseResult>,
    studies: BTreeMap<String, Measured>,
}

/// Finished cases and studies with their checkpoint file.
pub(super) struct Finished {
    file: Checkpoint,
    count: Arc<AtomicUsize>,
    state: Mutex<State>,
}

impl Finished {
    /// Opens or creates the checkpoint, if there is to be one. A checkpoint of other input or of another build is an
    /// error.
    pub(super) fn open(
        path: Option<&Path>,
        command: &'static str,
        input: Value,
        writing: &Writing,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = path else { return Ok(None) };
        let file = Checkpoint::open(path, command, input)?;
        let state: State = file.read()?.unwrap_or_default();
        file.write(&state)?;
        let path = path.display().to_string();
        let counted = [(state.cases.len(), "cases"), (state.studies.len(), "studies")];
        let counted = counted.iter().filter(|(count, _)| *count > 0);
        let counted: Vec<_> = counted.map(|(count, of)| format!("finished {of}: {count}")).collect();
        if !counted.is_empty() {
            writing.print(&format!("goes on from {path}: {}\n", counted.join(", ")))?;
        }
        let count = Arc::new(AtomicUsize::new(state.cases.len() + state.studies.len()));
        let kept = count.clone();
        on_stop(move || {
            Some(match kept.load(Ordering::Relaxed) {
                0 => format!("no case or study is finished, and {path} has none"),
                count => format!(
                    "finished cases and studies are saved in {path} ({count}), and the same command goes on from there"
                ),
            })
        });
        Ok(Some(Self { file, count, state: Mutex::new(state) }))
    }

    /// The result of a finished case.
    pub(super) fn case(&self, name: &str) -> Option<CaseResult> {
        self.state().cases.get(name).cloned()
    }

    /// Adds a finished case and writes the checkpoint.
    pub(super) fn add_case(&self, name: &str, result: &CaseResult) -> Result<(), Failure> {
        let mut state = self.state();
        if state.cases.insert(name.to_owned(), result.clone()).as_ref() == Some(result) {
            return Ok(());
        }
        self.write(&state)
    }

    fn write(&self, state: &State) -> Result<(), Failure> {
        self.file.write(state)?;
        self.count.store(state.cases.len() + state.studies.len(), Ordering::Relaxed);
        Ok(())
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The findings of a study and its seconds: those that are finished, or those of a run, which are added. `None` if the
/// study finds nothing here.
pub(super) fn measured(
    finished: Option<&Finished>,
    name: &str,
    run: impl FnOnce() -> Result<Option<Findings>, Failure>,
) -> Result<Option<Measured>, Failure> {
    if let Some(found) = finished.and_then(|finished| finished.state().studies.get(name).cloned()) {
        return Ok(Some(found));
    }
    let start = Instant::now();
    let Some(found) = run()? else { return Ok(None) };
    let measured = (found, start.elapsed().as_secs_f64());
    if let Some(finished) = finished {
        let mut state = finished.state();
        state.studies.insert(name.to_owned(), measured.clone());
        finished.write(&state)?;
    }
    Ok(Some(measured))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use shearbed_validation::present::plot::{Curve, Figure, Grid, Map, Points};
    use shearbed_validation::present::study::{Exhibit, ReportFigure, ScenePlan};
    use shearbed_validation::present::table::{ReportTable, field, of_words};

    /// Findings of every kind, with numbers that lose digits in text, and whole numbers that are not counts.
    fn found() -> Findings {
        let cells = vec![Some(0.1), Some(-0.0), Some(3.0), None];
        let column = field("x", |x: &Option<f64>| *x);
        let count = field("n", |x: &Option<f64>| x.map(|x| x as u64));
        let numbers = ReportTable::new(["numbers", "Numbers"], "some", cells, vec![column, count]);
        let curve = Curve {
            label: "curve".into(),
            x: vec![5e-324, 1.0 / 3.0],
            y: vec![f64::INFINITY, 2.0],
            half_band: Some(vec![0.5, 0.25]),
        };
        let points = Points { x_error: Some(vec![1.0]), ..Points::default() };
        let map = Map { cells: vec![vec![0, 1]], limit: vec![(0.5, 1.0)], ..Map::default() };
        let figure = Figure {
            curves: vec![curve],
            points: vec![points],
            x_span: Some((0.0, 1.0)),
            grid: Some(Grid { maps: vec![map], ..Grid::default() }),
            ..Figure::default()
        };
        let figure = ReportFigure { figure, cases: vec!["kick-bound".into()], ..ReportFigure::default() };
        Findings {
            answer: "Yes.".into(),
            exhibits: vec![
                Exhibit::both(figure, numbers),
                of_words("words", "Words", "", &["word"], vec![vec!["1".into()]]).into(),
            ],
            files: vec![("curves/fig5.csv".into(), "x\n".into())],
            plans: vec![ScenePlan { seed: u64::MAX, ..ScenePlan::default() }],
        }
    }

    #[test]
    fn what_is_finished_is_there_again_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("kept");
        let quiet = Writing { force: false, quiet: true };
        let open = || Finished::open(Some(&path), "validate", json!({ "seed": 1 }), &quiet).unwrap().unwrap();
        let ended: CaseResult = (Verdict::Pass, Vec::new(), Vec::new(), 0.3);
        let first = open();
        let study = measured(Some(&first), "figures", || Ok(Some(found()))).unwrap();
        first.add_case("kick-bound", &ended).unwrap();
        drop(first);
        let again = open();
        let kept = |name| measured(Some(&again), name, || Ok(None)).unwrap();
        assert!(study.as_ref().is_some_and(|(findings, _)| *findings == found()));
        assert_eq!(kept("figures"), study);
        assert_eq!(again.case("kick-bound"), Some(ended));
        assert!(again.case("figures").is_none() && kept("kick-bound").is_none());
    }
}
