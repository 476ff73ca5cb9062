//! The memory that the control groups of Linux leave to this program. Those of a process may be nested, as under Slurm,
//! and each may have a limit.

use std::fs::read_to_string;
use std::path::Path;

/// The bytes that the control groups of this process leave it; `None` if none has a limit.
pub(super) fn free() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    free_in(Path::new("/sys/fs/cgroup"), &groups)
}

/// The same for groups as `/proc/self/cgroup` lists them, in a folder of control groups.
fn free_in(root: &Path, groups: &str) -> Option<u64> {
    groups.lines().filter_map(|line| free_of_line(root, line)).min()
}

/// A line is `0::/path` for version 2 of control groups, and `number:memory:/path` for version 1.
fn free_of_line(root: &Path, line: &str) -> Option<u64> {
    let mut fields = line.splitn(3, ':').skip(1);
    let (controllers, path) = (fields.next()?, fields.next()?);
    let (root, files) = match controllers {
        "" => (root.to_path_buf(), &VERSION_2),
        _ if controllers.split(',').any(|controller| controller == "memory") => {
            (root.join("memory"), &VERSION_1)
        }
        _ => return None,
    };
    let own = root.join(path.trim_start_matches('/'));
    let all = own.ancestors().take_while(|folder| folder.starts_with(&root));
    all.filter_map(|folder| files.free(folder)).min()
}

/// What a version of control groups calls its files, and in the statistics what cannot be given back.
struct Files {
    limit: &'static str,
    used: [&'static str; 2],
}

const VERSION_1: Files =
    Files { limit: "memory.limit_in_bytes", used: ["total_rss", "total_shmem"] };

const VERSION_2: Files = Files { limit: "memory.max", used: ["anon", "shmem"] };

impl Files {
    /// What a group leaves; `None` if it has no limit.
    fn free(&self, folder: &Path) -> Option<u64> {
        let limit: u64 = read_to_string(folder.join(self.limit)).ok()?.trim().parse().ok()?;
        let statistics = read_to_string(folder.join("memory.stat")).ok()?;
        let value = |line: &str| {
            let (name, value) = line.split_once(' ')?;
            self.used.contains(&name).then_some(value)?.trim().parse::<u64>().ok()
        };
        let used = statistics.lines().filter_map(value).fold(0_u64, u64::saturating_add);
        Some(limit.saturating_sub(used))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(root: &Path, path: &str, files: [(&str, &str); 2]) {
        let folder = root.join(path);
        std::fs::create_dir_all(&folder).unwrap();
        for (name, text) in files {
            std::fs::write(folder.join(name), text).unwrap();
        }
    }

    #[test]
    fn the_tightest_of_nested_groups_counts() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let of = |limit, statistics| [("memory.max", limit), ("memory.stat", statistics)];
        group(root, "slurm", of("1000\n", "anon 100\nfile 500\nshmem 20\n"));
        group(root, "slurm/job", of("2000\n", "anon 10\nfile 500\n"));
        group(root, "slurm/job/step", of("max\n", "anon 10\n"));
        assert_eq!(free_in(root, "0::/slurm/job/step\n"), Some(880));
        assert_eq!(free_in(root, "0::/slurm/job/step/task\n"), Some(880));
        group(root, "slurm/job/step", of("300\n", "anon 400\n"));
        assert_eq!(free_in(root, "0::/slurm/job/step\n"), Some(0));
        assert_eq!(free_in(root, "0::/\n"), None);
        assert_eq!(free_in(root, "nonsense\n1:\n"), None);
    }

    #[test]
    fn version_1_has_a_folder_for_memory() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let files = [
            ("memory.limit_in_bytes", "5000\n"),
            ("memory.stat", "rss 7\ntotal_rss 1200\ntotal_shmem 300\ntotal_cache 3000\n"),
        ];
        group(root, "memory/pin", files);
        let groups = "4:cpu,cpuacct:/\n3:memory:/pin\n0::/unified\n";
        assert_eq!(free_in(root, groups), Some(3500));
    }
}
