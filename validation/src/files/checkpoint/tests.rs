use super::*;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// Numbers that a text format may not preserve.
fn state() -> Vec<f64> {
    vec![0.1, -0.0, f64::NAN, 5e-324, f64::INFINITY, 1.0 / 3.0]
}

fn bits(state: &[f64]) -> Vec<u64> {
    state.iter().map(|x| x.to_bits()).collect()
}

fn opened(path: &Path, seed: u64) -> Checkpoint {
    Checkpoint::open(path, "test", json!({ "scene": { "seed": seed } })).unwrap()
}

fn kept() -> (TempDir, PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("below/kept");
    let file = opened(&path, 1);
    assert!(file.read::<Vec<f64>>().unwrap().is_none(), "nothing is there yet");
    file.write(&vec![7.0]).unwrap();
    file.write(&state()).unwrap();
    (dir, path)
}

/// The reason why the file is refused with these bytes; it must not change.
fn refused(path: &Path, bytes: &[u8], seed: u64) -> String {
    fs::write(path, bytes).unwrap();
    let Refused(why) = opened(path, seed).read::<Vec<f64>>().unwrap_err();
    assert!(why.starts_with(&format!("--checkpoint {}: ", path.display())), "{why}");
    assert_eq!(fs::read(path).unwrap(), bytes);
    why
}

/// The same bytes with a correct checksum.
fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() - SUM as usize);
    let sum = crc32fast::hash(&bytes).to_be_bytes();
    bytes.extend(sum);
    bytes
}

#[test]
fn what_was_kept_is_read_bit_for_bit_and_nothing_lies_beside_it() {
    let (_dir, path) = kept();
    let found: Vec<f64> = opened(&path, 1).read().unwrap().unwrap();
    assert_eq!(bits(&found), bits(&state()));
    let beside = fs::read_dir(path.parent().unwrap()).unwrap().count();
    assert_eq!(beside, 1);
}

#[test]
fn every_damaged_byte_and_every_cut_is_seen() {
    let (_dir, path) = kept();
    let whole = fs::read(&path).unwrap();
    for at in 0..whole.len() {
        for change in [1, 0x80] {
            let mut bytes = whole.clone();
            bytes[at] ^= change;
            let why = refused(&path, &bytes, 1);
            let known = ["is damaged", "is no checkpoint", "has the format"];
            assert!(known.iter().any(|known| why.contains(known)), "byte {at}: {why}");
        }
        refused(&path, &whole[..at], 1);
    }
    let longer = [&whole[..], b"x"].concat();
    assert!(refused(&path, &longer, 1).contains("its checksum is"));
}

#[test]
fn other_work_and_other_formats_are_refused_by_name() {
    let (_dir, path) = kept();
    let whole = fs::read(&path).unwrap();
    assert!(refused(&path, &whole, 2).contains("is of other work: scene.seed was 1 and is 2 now"));
    let text = String::from_utf8_lossy(&whole[..24]).into_owned();
    assert!(text.starts_with("shearbed checkpoint 3\n"), "{text}");
    let mut other = whole.clone();
    other[HEAD.len()] = b'1';
    assert!(refused(&path, &summed(other), 1).contains("has the format 1, of another version"));
    for build in ["version", "commit"] {
        let own = json!(BUILD)[build].to_string();
        let at = whole.windows(own.len()).position(|bytes| bytes == own.as_bytes()).unwrap();
        let mut other = whole.clone();
        other[at + 1] = b'Z';
        let why = refused(&path, &summed(other), 1);
        assert!(why.contains(&format!("is of other work: build.{build} was \"Z")), "{why}");
    }
    // The checksum is correct, but the contents are no state.
    let mut cut = whole.clone();
    cut.remove(whole.len() - 5);
    assert!(refused(&path, &summed(cut), 1).contains("is damaged"));
    let longer = summed([&whole[..whole.len() - 4], b"x1234"].concat());
    assert!(refused(&path, &longer, 1).contains("bytes follow its state"));
    assert!(refused(&path, b"", 1).contains("is no checkpoint"));
}

#[test]
fn one_process_at_a_time_and_files_alone() {
    let (dir, path) = kept();
    let held = opened(&path, 1);
    let Refused(why) = Checkpoint::open(&path, "test", json!({})).err().unwrap();
    assert!(why.contains("another shearbed is at work with this file"), "{why}");
    drop(held);
    let Refused(why) = Checkpoint::open(dir.path(), "test", json!({})).err().unwrap();
    assert!(why.contains("it is a folder; a regular file is needed"), "{why}");
    // Of two that begin, the second is refused when it writes.
    let new = dir.path().join("new");
    let [first, second] = [opened(&new, 1), opened(&new, 2)];
    first.write(&state()).unwrap();
    let why = second.write(&state()).unwrap_err().to_string();
    assert!(why.contains("another shearbed is at work with this file"), "{why}");
    let Refused(why) = Checkpoint::open(Path::new(".."), "test", json!({})).err().unwrap();
    assert!(why.contains("the name of a file is allowed"), "{why}");
    #[cfg(target_os = "linux")]
    assert!(opened(Path::new("/proc/x"), 1).write(&state()).is_err());
}

/// Replica 0 is in the sum, 2 waits for its turn, 3 is in work.
#[test]
fn nothing_that_is_done_is_run_again() {
    use crate::judge::lab;
    use shearbed::run::{go_on, run_replica};
    use std::sync::atomic::{AtomicU64, Ordering};

    let mut scene = lab::interacting_scene(&crate::judge::case::Effort::gate());
    scene.ensemble.replicas = 6;
    scene.time.duration = 0.5;
    let plan = lab::plan(&scene);
    let mut tally = shearbed::run::ensemble::Tally::new(&plan);
    tally.add(run_replica(&plan, 0).unwrap());
    let mut looks = 0;
    let mut halfway = Vec::new();
    go_on(&plan, 3, None, |state| {
        looks += 1;
        halfway.extend((looks == 20).then(state));
    })
    .unwrap();
    let mut kept = saved::Saved {
        asked: 6,
        tally,
        done: [(2, run_replica(&plan, 2).unwrap())].into(),
        halfway: [(3, halfway.remove(0))].into(),
    };
    let expected = shearbed::run::ensemble::run(&plan).unwrap();
    for threads in [1, 2, 4, 9] {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("kept");
        let file = Checkpoint::open(&path, "run", json!({ "scene": super::without_replicas(plan.scene()) })).unwrap();
        file.write(&kept).unwrap();
        drop(file);
        let run = Replicas::open(&plan, &path, std::time::Duration::from_millis(10)).unwrap();
        let of_run = |done, halfway| Progress { done, halfway, all: 6 };
        assert_eq!(run.progress(), of_run(2, 1));
        let finished = AtomicU64::new(0);
        let last = std::sync::Mutex::new(None);
        let count = || {
            finished.fetch_add(1, Ordering::Relaxed);
        };
        assert_eq!(
            run.run(threads, count, |saved| *last.lock().unwrap() = Some(saved.unwrap())).unwrap(),
            expected,
            "{threads}"
        );
        assert_eq!((finished.into_inner(), run.progress()), (4, of_run(6, 0)));
        // The progress reported last is that in the file.
        assert_eq!(last.into_inner().unwrap(), Some(of_run(6, 0)));
        run.run(threads, || panic!("all are done"), |_| panic!("nothing is new")).unwrap();
    }
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("kept");
    let open = |plan: &shearbed::Plan| Replicas::open(plan, &path, std::time::Duration::from_secs(1));
    let keep = |kept: &saved::Saved| {
        let inputs = json!({ "scene": super::without_replicas(plan.scene()) });
        Checkpoint::open(&path, "run", inputs).unwrap().write(kept).unwrap();
    };
    // After the deadline none begins but the first two.
    let run = open(&plan).unwrap();
    run.run_to(1, (6, Some(std::time::Instant::now())), || (), |_| ()).unwrap();
    assert_eq!(run.replicas(), 2);
    drop(run);
    // A replica that is in the sum already is no part of the rest.
    kept.done.insert(0, run_replica(&plan, 0).unwrap());
    keep(&kept);
    let Refused(why) = open(&plan).err().unwrap();
    assert!(why.contains("it has a replica that this run has finished"), "{why}");
    // Those of several lack what one has, once they have begun.
    let one = plan.with_replicas(1);
    (kept.tally, kept.halfway) = (shearbed::run::ensemble::Tally::new(&one), [].into());
    kept.done.retain(|replica, _| *replica == 0);
    for has_begun in [true, false] {
        keep(&kept);
        assert_eq!(open(&one).is_err(), has_begun);
        kept.done.clear();
    }
    // One that was asked for alone is the first of several.
    (kept.asked, kept.done) = (1, [(0, run_replica(&one, 0).unwrap())].into());
    keep(&kept);
    assert_eq!(open(&plan).unwrap().run(2, || (), |_| ()).unwrap(), expected);
}

/// A disk with free space for this number of bytes.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Wherever the disk becomes full, in a length, a name or a number, the reason is the disk's.
#[test]
fn a_full_disk_is_told_in_the_systems_words() {
    let state = std::collections::BTreeMap::from([("a".to_owned(), state()), ("text".to_owned(), Vec::new())]);
    let whole = rmp_serde::to_vec_named(&state).unwrap().len();
    for room in 0..whole {
        let error = rmp_serde::encode::write_named(&mut Full(room), &state).unwrap_err();
        assert_eq!(cause(error).kind(), io::ErrorKind::StorageFull, "{room}");
    }
    assert!(rmp_serde::encode::write_named(&mut Full(whole), &state).is_ok());
    let own = rmp_serde::encode::Error::UnknownLength;
    assert_eq!(cause(own).kind(), io::ErrorKind::Other);
}
