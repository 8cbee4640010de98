//! The memory that is still available to this process.

use shearbed_validation::files::bounded;
use std::path::Path;

/// Bytes still available: the least of the machine's, of those of the process's control groups, and of those within a
/// shell's `ulimit -v` and `-d`. `None` if the system does not report them.
pub(super) fn available() -> Option<u64> {
    let machine = number_of(&text("/proc/meminfo")?, "MemAvailable:")?;
    let groups = text("/proc/self/cgroup").and_then(|groups| of_groups(Path::new("/sys/fs/cgroup"), &groups));
    [within_limits(), groups, Some(machine)].into_iter().flatten().min()
}

/// Bytes left within a shell's `ulimit -v` and `-d`; `None` where neither is set.
pub(super) fn within_limits() -> Option<u64> {
    of_limits(&text("/proc/self/limits")?, &text("/proc/self/status")?)
}

/// The text of a short file of the system.
fn text(path: impl AsRef<Path>) -> Option<String> {
    bounded::text(path.as_ref(), 1 << 20).ok()
}

/// The value of a line such as `MemAvailable:  17 kB`, in bytes.
fn number_of(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// Bytes left within the process's own limits of address space and of data.
fn of_limits(limits: &str, status: &str) -> Option<u64> {
    let left = |limit: &str, used: &str| {
        let line = limits.lines().find_map(|line| line.strip_prefix(limit))?;
        // "unlimited" is not a number.
        let most: u64 = line.split_whitespace().next()?.parse().ok()?;
        Some(most.saturating_sub(number_of(status, used)?))
    };
    let space = left("Max address space", "VmSize:");
    space.into_iter().chain(left("Max data size", "VmData:")).min()
}

/// Bytes left within the control groups: each limits all groups below it. `groups` is the text of `/proc/self/cgroup`,
/// with lines such as `0::/a/b` (version 2) or `4:memory:/a/b` (version 1).
fn of_groups(root: &Path, groups: &str) -> Option<u64> {
    let mut least = None;
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else {
            continue;
        };
        let (top, most, used, reclaimable) = match controllers {
            "" => (root.to_owned(), "memory.max", "memory.current", "inactive_file "),
            names if names.split(',').any(|name| name == "memory") => {
                (root.join("memory"), "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file ")
            }
            _ => continue,
        };
        // In a container the path is often that of the host, and only the top folder exists.
        let own = top.join(path.trim_start_matches('/'));
        for group in own.ancestors().take_while(|group| group.starts_with(&top)) {
            let text = |file: &str| text(group.join(file));
            let number = |file: &str| text(file)?.trim().parse::<u64>().ok();
            let Some((most, used)) = number(most).zip(number(used)) else {
                continue;
            };
            let stat = text("memory.stat").unwrap_or_default();
            let freed = stat.lines().find_map(|line| line.strip_prefix(reclaimable)?.parse().ok());
            let used = used.saturating_sub(freed.unwrap_or(0));
            least = least.into_iter().chain([most.saturating_sub(used)]).min();
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn limits_of_the_shell_count() {
        let limits = |space: &str, data: &str| {
            format!(
                "Limit                     Soft Limit           Hard Limit           Units\n\
                 Max data size             {data}            unlimited            bytes\n\
                 Max address space         {space}            unlimited            bytes\n"
            )
        };
        let status = "VmPeak:\t    90 kB\nVmSize:\t    10 kB\nVmData:\t    4 kB\n";
        let kb = 1024;
        assert_eq!(number_of("MemTotal: 24 kB\nMemAvailable:   17 kB\n", "MemAvailable:"), Some(17 * kb));
        assert_eq!(number_of("MemTotal: 24 kB", "MemAvailable:"), None);
        assert_eq!(of_limits(&limits("unlimited", "unlimited"), status), None);
        assert_eq!(of_limits(&limits("102400", "unlimited"), status), Some(90 * kb));
        assert_eq!(of_limits(&limits("102400", "20480"), status), Some(16 * kb));
        assert_eq!(of_limits(&limits("1024", "unlimited"), status), Some(0));
    }

    #[test]
    fn every_group_above_counts() {
        let root = tempfile::tempdir().unwrap();
        let group = |path: &str, files: [(&str, &str); 3]| {
            let dir = root.path().join(path);
            fs::create_dir_all(&dir).unwrap();
            for (name, text) in files {
                fs::write(dir.join(name), text).unwrap();
            }
        };
        let of = |groups: &str| of_groups(root.path(), groups);
        assert_eq!(of("0::/a/b\n"), None);
        group("a/b", [("memory.max", "max\n"), ("memory.current", "5\n"), ("memory.stat", "")]);
        assert_eq!(of("0::/a/b\n"), None);
        let stat = "anon 30\ninactive_file 15\n";
        group("a", [("memory.max", "100\n"), ("memory.current", "40\n"), ("memory.stat", stat)]);
        assert_eq!(of("0::/a/b\n"), Some(75));
        // The files of version 1 are in other places; in a container the path may be that of the host.
        let v1 = [
            ("memory.limit_in_bytes", "90\n"),
            ("memory.usage_in_bytes", "20\n"),
            ("memory.stat", "total_inactive_file 3\n"),
        ];
        group("memory", v1);
        assert_eq!(of("2:cpu,cpuacct:/x\n4:memory:/docker/abc\n"), Some(73));
    }
}
