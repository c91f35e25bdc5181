//! `candor replay`: one sample traced again.

use crate::candor::{Folder, Running, dark_scene, without_vulkan};

/// The label of a line and what follows.
fn row<'a>(table: &'a str, label: &str) -> &'a str {
    let line = table.lines().find(|line| line.trim_start().starts_with(label));
    line.unwrap_or_else(|| panic!("no {label} in: {table}"))
}

#[test]
fn both_paths_stand_side_by_side() {
    let folder = Folder::new();
    for estimator in ["implicit", "cosine", "explicit", "mis"] {
        let arguments = format!("replay scene.toml --pixel 4,4 --sample 3 --estimator {estimator}");
        let table = folder.candor(&arguments).silently_done();
        let heading = ["device", "twin", "difference"];
        assert!(table.lines().any(|line| line.split_whitespace().eq(heading)), "{table}");
        assert_eq!(row(&table, "vertex 1").matches("floor (diffuse)").count(), 2, "{table}");
        for label in ["distance", "position", "normal", "weight", "direction", "end", "radiance"] {
            row(&table, label);
        }
        assert_eq!(row(&table, "valid").matches("yes").count(), 2, "{table}");
        assert!(table.ends_with("the same path on both, up to rounding\n"), "{table}");
        let widest = table.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(100), "{widest:?} characters in: {table}");
        let lights = table.contains("lamp, visible") || table.contains("lamp, hidden");
        assert_eq!(lights, ["explicit", "mis"].contains(&estimator), "{table}");
    }
    // Replaying writes nothing.
    assert_eq!(folder.files(), [""; 0]);
}

/// Straight into the lamp, past everything, and down to the last bounce.
#[test]
fn endings_are_said() {
    let folder = Folder::new();
    let ending = |arguments: &str| {
        let table = folder.candor(&format!("replay scene.toml --device cpu {arguments}"));
        row(&table.silently_done(), "end").trim_start()["end".len()..].trim().to_owned()
    };
    assert_eq!(ending("--pixel 4,1 --sample 0"), "on a light");
    assert_eq!(ending("--pixel 0,0 --sample 0"), "escaped");
    assert_eq!(ending("--pixel 4,5 --sample 0 --bounces 0"), "at the limit of bounces");
}

#[test]
fn json_has_both_paths() {
    let folder = Folder::new();
    let ended = folder.candor("replay scene.toml --pixel 4,1 --sample 72057594037927935 --json");
    let json = ended.with_code(0).json();
    assert_eq!(json["sample"], (1_u64 << 56) - 1);
    assert_eq!(json["parting"], serde_json::Value::Null);
    for path in ["device_path", "twin_path"] {
        let path = &json[path];
        assert_eq!(
            (&path["ending"], &path["invalid"]),
            (&"light".into(), &serde_json::Value::Null)
        );
        assert_eq!(path["segments"][0]["vertex"]["name"], "lamp");
        assert_eq!(path["radiance"][0], 0.5);
    }
}

/// Without a device the twin's path stands alone, and that is said; so does `--device cpu`,
/// without a word about it.
#[cfg(target_os = "linux")]
#[test]
fn without_a_device_the_twin_stands_alone() {
    let folder = Folder::new();
    let arguments = "replay scene.toml --pixel 4,1 --sample 0";
    let ended = Running::start(without_vulkan(&mut folder.command(arguments))).end().with_code(0);
    assert!(ended.stderr.contains("the twin's path alone"), "{}", ended.stderr);
    let asked = folder.candor(&format!("{arguments} --device cpu")).silently_done();
    assert_eq!(ended.stdout, asked);
    assert!(row(&asked, "device").ends_with("none"), "{asked}");
}

#[test]
fn scenes_without_lights_have_paths_too() {
    let folder = Folder::new();
    folder.write("dark.toml", dark_scene());
    let arguments = "replay dark.toml --pixel 4,4 --sample 0 --estimator mis";
    let table = folder.candor(arguments).silently_done();
    assert!(table.ends_with("the same path on both, up to rounding\n"), "{table}");
}

#[test]
fn impossible_addresses_are_refused() {
    let folder = Folder::new();
    let table = [
        ("--pixel 8,0 --sample 0", "--pixel 8,0 is not in the picture of 8x6 pixels"),
        ("--pixel 0,6 --sample 0", "rows from 0 at the top to 5"),
        ("--pixel 8 --sample 0", "expected COLUMN,ROW in whole numbers"),
        ("--pixel=-1,0 --sample 0", "expected COLUMN,ROW in whole numbers"),
        ("--pixel 0,0 --sample 72057594037927936", "is not in 0..72057594037927936"),
        ("--pixel 0,0", "--sample <K>"),
        ("--sample 0", "--pixel <X,Y>"),
        ("--pixel 0,0 --sample 0 --estimator auto", "--estimator auto is for render"),
    ];
    for (arguments, part) in table {
        folder.candor(&format!("replay scene.toml {arguments}")).refused(&[part]);
    }
}

/// A strict render without invalid samples is like any other.
#[test]
fn strict_renders_without_invalid_samples_are_done() {
    let folder = Folder::new();
    for device in ["cpu", "gpu"] {
        let arguments = format!("render scene.toml --strict --device {device} --json --quiet");
        let json = folder.candor(&arguments).with_code(0).json();
        assert_eq!(json["invalid_samples"], 0);
        assert_eq!(json["invalid_records"].as_array().map(Vec::len), Some(0));
    }
}
