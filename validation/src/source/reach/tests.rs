use super::*;

#[test]
fn what_tests_alone_call_is_not_reached() {
    let mut source = Source::default();
    source.add(
        "scene_file",
        "pub fn parse() -> Scene { toml::from_str::<Scene>() }",
    );
    source.add(
        "scene",
        "pub struct Scene { #[serde(default = \"three\")] m: f64 } fn three() -> f64 { 3.0 } fn four() {}",
    );
    source.add(
        "run",
        "pub fn run_replica(p: &Plan) { let idle = 1; used(idle); let used = used(1.0); let x = p.turned(); other::passed; vec![in_macro(1)];
         let rate = |k| k; rate(1); }
         pub fn used(rate: f64) -> f64 { rate }
         pub fn idle() {}
         fn in_macro(n: u8) {}
         pub struct Plan; impl Plan { pub fn turned(&self) {} pub fn probability(&self) { idle() } }
         #[cfg(test)] mod tests { fn of_tests() { super::idle(); } }",
    );
    source.add(
        "other",
        "pub fn passed() {} pub fn rate() { hidden() } fn hidden() {}",
    );
    for (module, name) in [
        ("scene", "three"),
        ("run", "used"),
        ("run", "turned"),
        ("run", "in_macro"),
        ("other", "passed"),
    ] {
        assert_eq!(source.runs(module, name), Some(true), "{name}");
    }
    // A variable and a parameter of that name are no calls; what is idle calls in vain.
    for (module, name) in [
        ("scene", "four"),
        ("run", "idle"),
        ("run", "probability"),
        ("other", "rate"),
        ("other", "hidden"),
    ] {
        assert_eq!(source.runs(module, name), Some(false), "{name}");
    }
    assert_eq!(source.runs("run", "of_tests"), None);
    assert_eq!(source.runs("other", "used"), None);
    assert_eq!(source.idle("run"), ["idle", "probability"]);
}
