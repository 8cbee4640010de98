//! A scene that would not fit in memory says so before it starts.

use super::Failure;
use shearbed::{Plan, memory};
use std::fs::read_to_string;

/// Refuses a plan that needs more memory than there is, with `threads` replicas at a time. Where the system does not say
/// what there is, nothing is refused.
pub(super) fn check(plan: &Plan, threads: Option<u64>, source: &str) -> Result<(), Failure> {
    let cores = || std::thread::available_parallelism().map_or(1, |cores| cores.get() as u64);
    let threads = threads.unwrap_or_else(cores);
    match available() {
        Some(free) => {
            fits(plan, threads, free).map_err(|message| Failure::Input(format!("{source}: {message}")))
        }
        None => Ok(()),
    }
}

fn fits(plan: &Plan, threads: u64, free: u64) -> Result<(), String> {
    let needed = memory::bytes(plan, threads);
    if needed <= free {
        return Ok(());
    }
    let replicas = threads.min(plan.scene().ensemble.replicas);
    let (least, size) = (memory::bytes(plan, 1), |bytes: u64| {
        format!("{:.2} GB", 1e-9 * bytes as f64)
    });
    let allowed = match least <= free {
        true => format!("fewer --threads: {} with one", size(least)),
        false => format!("fewer: one replica needs {}", size(least)),
    };
    Err(format!(
        "particles.count = {}: {replicas} at a time of {} replicas, with {} outputs each, need {} of memory, and {} are \
         free; allowed: {allowed}",
        plan.scene().particles.count,
        plan.scene().ensemble.replicas,
        plan.outputs(),
        size(needed),
        size(free),
    ))
}

/// Bytes that can still be had: of the machine, and of the control group that the process is in.
fn available() -> Option<u64> {
    let machine = of_meminfo(&read_to_string("/proc/meminfo").ok()?)?;
    let number = |file: &str| {
        let text = read_to_string(format!("/sys/fs/cgroup/{file}")).ok()?;
        text.trim().parse::<u64>().ok()
    };
    let group = number("memory.max").zip(number("memory.current"));
    Some(group.map_or(machine, |(most, used)| machine.min(most.saturating_sub(used))))
}

fn of_meminfo(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::lab;

    #[test]
    fn meminfo_is_read() {
        let text = "MemTotal:       24 kB\nMemFree:        3 kB\nMemAvailable:   17 kB\n";
        assert_eq!(of_meminfo(text), Some(17 * 1024));
        assert_eq!(of_meminfo("MemTotal: 24 kB"), None);
    }

    #[test]
    fn what_does_not_fit_is_refused_with_its_number() {
        let mut scene = lab::interacting_scene(&crate::case::Effort::gate());
        scene.particles.count = 10_000_000;
        scene.ensemble.replicas = 3;
        let plan = lab::plan(&scene);
        let one = memory::bytes(&plan, 1);
        assert!((1.0e9..1.2e9).contains(&(one as f64)), "{one}");
        assert_eq!(fits(&plan, 1, one), Ok(()));
        let refused = fits(&plan, 2, one).unwrap_err();
        assert!(
            refused.starts_with("particles.count = 10000000: 2 at a time of 3 replicas")
                && refused.contains("fewer --threads"),
            "{refused}"
        );
        assert!(
            fits(&plan, 1, one - 1)
                .unwrap_err()
                .contains("fewer: one replica needs 1.")
        );
    }
}
