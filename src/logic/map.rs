//! The map: a layout as JSON, for tools that watch a running program and for the next build, which keeps its offsets.
//!
//! What is read was written by anyone: it must be checked until placing further slots behind it cannot go wrong.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::image::{EarlierLayout, Extent, KeptSlot};
use super::print::{area_name, area_of};
use super::{Array, Layout, Program, Task};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::source::{Source, Span};

/// The version of the form, which changes when an older reader would misread a map.
const VERSION: u32 = 1;

#[derive(Serialize, Deserialize)]
struct Map {
    version: u32,
    /// The program's name.
    program: String,
    /// The name of the source file.
    source: String,
    /// [`Layout::hash`] in 16 hexadecimal digits.
    layout: String,
    size: u32,
    slots: Vec<MapSlot>,
    observed: Vec<MapObserved>,
    /// Where these two are missing, an earlier version wrote the map.
    #[serde(default)]
    arrays: Vec<MapArray>,
    #[serde(default)]
    tasks: Vec<MapTask>,
    inputs: Vec<MapInputs>,
    outputs: Vec<[u32; 2]>,
    retained: Vec<[u32; 2]>,
}

#[derive(Serialize, Deserialize)]
struct MapSlot {
    name: String,
    #[serde(rename = "type")]
    ty: String,
    offset: u32,
    direction: String,
    retain: bool,
    /// In the source, from 1; 0 where there is none.
    line: u32,
}

/// A name that can be watched, and the name of the slot that it shows.
#[derive(Serialize, Deserialize)]
struct MapObserved {
    name: String,
    slot: String,
}

/// Elements side by side: the name of the first slot, and how many there are.
#[derive(Serialize, Deserialize)]
struct MapArray {
    first: String,
    count: u32,
}

/// A task with a name or an interval, in the order in which those run that are due.
#[derive(Serialize, Deserialize)]
struct MapTask {
    name: String,
    /// In nanoseconds; `null` where it runs in every round.
    interval: Option<i64>,
    /// The name of the slot that holds when it is due next.
    due: Option<String>,
}

/// Start and end of a run of inputs, and of the BOOLs in it.
#[derive(Serialize, Deserialize)]
struct MapInputs {
    bytes: [u32; 2],
    bools: [u32; 2],
}

/// The map of a program as JSON text with a line break at its end. All offsets are in bytes from the image's start; the
/// end of a run is one past its last byte.
pub fn write_map(program: &Program, source_name: &str) -> String {
    let layout = &program.layout;
    let pair = |range: &Range<u32>| [range.start, range.end];
    let map = Map {
        version: VERSION,
        program: program.name.clone(),
        source: source_name.to_owned(),
        layout: format!("{:016x}", layout.hash()),
        size: layout.size(),
        slots: layout
            .slots()
            .iter()
            .map(|slot| MapSlot {
                name: slot.name.to_string(),
                ty: slot.ty.name().to_owned(),
                offset: slot.offset,
                direction: area_name(slot.area).to_owned(),
                retain: slot.retain,
                line: slot.line,
            })
            .collect(),
        observed: observed(layout),
        arrays: arrays(layout),
        tasks: tasks(program),
        inputs: layout
            .inputs()
            .iter()
            .map(|extent| MapInputs { bytes: pair(&extent.bytes), bools: pair(&extent.bools) })
            .collect(),
        outputs: layout.outputs().iter().map(pair).collect(),
        retained: layout.retained().iter().map(pair).collect(),
    };
    // Strings, numbers and lists of them: there is nothing that JSON could not hold.
    let mut text = serde_json::to_string_pretty(&map).unwrap_or_default();
    text.push('\n');
    text
}

fn observed(layout: &Layout) -> Vec<MapObserved> {
    let of = |observed: &super::image::Observed| MapObserved {
        name: observed.name.to_string(),
        slot: layout.slot(observed.slot).name.to_string(),
    };
    layout.observed().iter().map(of).collect()
}

fn arrays(layout: &Layout) -> Vec<MapArray> {
    let of = |array: &Array| MapArray { first: layout.slot(array.first).name.to_string(), count: array.count };
    layout.arrays().iter().map(of).collect()
}

fn tasks(program: &Program) -> Vec<MapTask> {
    let of = |task: &Task| MapTask {
        name: task.name.clone(),
        interval: task.interval,
        due: task.due.map(|slot| program.layout.slot(slot).name.to_string()),
    };
    program.tasks.iter().filter(|task| !task.is_plain()).map(of).collect()
}

/// The layout that a map tells, fit to be extended.
///
/// # Errors
/// [`Code::BadMap`], when it is no JSON of this form, has another version, or tells a layout that cannot be: see
/// [`EarlierLayout::problems`].
pub fn read_map(source: &Source) -> Result<EarlierLayout, Diagnostic> {
    let fault = |message: String| {
        Diagnostic::new(Code::BadMap, Span::default(), message).hint("give a map that `rung build --map` wrote")
    };
    let map: Map = serde_json::from_str(source.text()).map_err(|error| {
        let line = source.line_range(error.line().saturating_sub(1)).unwrap_or_default();
        let at = (line.start + error.column().saturating_sub(1)).min(line.end);
        Diagnostic { span: Span::new(at, at), ..fault(format!("this is no map: {error}")) }
    })?;
    if map.version != VERSION {
        return Err(fault(format!("this map has version {}, but {VERSION} is the one that is known", map.version)));
    }
    let slot = |slot: MapSlot| {
        let unknown = |word: &str| fault(format!("`{}` is `{word}`, which is not known", slot.name));
        Ok(KeptSlot {
            ty: Elementary::from_name(&slot.ty).ok_or_else(|| unknown(&slot.ty))?,
            area: area_of(&slot.direction).ok_or_else(|| unknown(&slot.direction))?,
            name: slot.name,
            retain: slot.retain,
            offset: slot.offset,
        })
    };
    let range = |[start, end]: [u32; 2]| start..end;
    let layout = EarlierLayout {
        slots: map.slots.into_iter().map(slot).collect::<Result<_, _>>()?,
        inputs: map.inputs.into_iter().map(|run| Extent { bytes: range(run.bytes), bools: range(run.bools) }).collect(),
        outputs: map.outputs.into_iter().map(range).collect(),
        retained: map.retained.into_iter().map(range).collect(),
        size: map.size,
    };
    match layout.problems().into_iter().next() {
        None => Ok(layout),
        Some(problem) => Err(fault(format!("this map tells an image that cannot be: {problem}"))),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::elementary::Value;
    use crate::logic::image::LayoutBuilder;
    use crate::logic::{Area, Builder, Slot, random};

    fn program(slots: &[(&str, Elementary, Area)], earlier: Option<&EarlierLayout>) -> Program {
        let mut layout = LayoutBuilder::new();
        for (line, (name, ty, area)) in (1..).zip(slots) {
            let (watched, name, initial) = (format!("{name}.Q"), (*name).to_owned(), Value::default_of(*ty));
            let retain = *area == Area::Output;
            let slot = layout.slot(Slot { name: name.into(), ty: *ty, offset: 0, area: *area, retain, initial, line });
            layout.observe(watched, slot);
        }
        Builder::new("pump", layout.finish(earlier).unwrap()).finish()
    }

    const SLOTS: [(&str, Elementary, Area); 3] = [
        ("start", Elementary::Bool, Area::Input),
        ("lamp", Elementary::Int, Area::Output),
        ("delay", Elementary::Time, Area::State),
    ];

    #[test]
    fn the_text_is_this() {
        let expected = r#"{
  "version": 1,
  "program": "pump",
  "source": "pump.rung",
  "layout": "HASH",
  "size": 16,
  "slots": [
    {
      "name": "start",
      "type": "BOOL",
      "offset": 0,
      "direction": "input",
      "retain": false,
      "line": 1
    },
    {
      "name": "lamp",
      "type": "INT",
      "offset": 2,
      "direction": "output",
      "retain": true,
      "line": 2
    }
  ],
  "observed": [
    {
      "name": "start.Q",
      "slot": "start"
    },
    {
      "name": "lamp.Q",
      "slot": "lamp"
    }
  ],
  "arrays": [],
  "tasks": [],
  "inputs": [
    {
      "bytes": [
        0,
        1
      ],
      "bools": [
        0,
        1
      ]
    }
  ],
  "outputs": [
    [
      2,
      4
    ]
  ],
  "retained": [
    [
      2,
      4
    ]
  ]
}
"#;
        let program = program(&SLOTS[..2], None);
        let hash = format!("{:016x}", program.layout.hash());
        assert_eq!(
            write_map(&program, "pump.rung"),
            expected.replace("HASH", &hash).replace("\"size\": 16", &format!("\"size\": {}", program.layout.size()))
        );
    }

    #[test]
    fn arrays_and_tasks_are_told() {
        let mut layout = LayoutBuilder::new();
        let mut slot = |name: &str, ty, area| {
            let (name, initial) = (name.to_owned(), Value::default_of(ty));
            layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
        };
        let elements = ["a[1]", "a[2]"].map(|name| slot(name, Elementary::Int, Area::Memory));
        let due = slot("#task fast", Elementary::Time, Area::State);
        layout.array(elements[0], 2);
        let mut builder = Builder::new("pump", layout.finish(None).unwrap());
        builder.end_task("fast", Some(10_000_000), Some(due));
        builder.end_task("", None, None);
        let text = write_map(&builder.finish(), "x");
        let map: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(map["arrays"], serde_json::json!([{ "first": "a[1]", "count": 2 }]));
        let fast = serde_json::json!({ "name": "fast", "interval": 10_000_000, "due": "#task fast" });
        assert_eq!(map["tasks"], serde_json::json!([fast]));
        // The same from before there were arrays and tasks.
        let mut earlier = map.clone();
        for key in ["arrays", "tasks"] {
            earlier.as_object_mut().unwrap().remove(key);
        }
        assert_eq!(read_map(&Source::new("map", earlier.to_string())), read_map(&Source::new("map", text)));
    }

    #[test]
    fn what_was_written_is_read() {
        for seed in 0..50 {
            let program = random::program(seed);
            let map = Source::new("map", write_map(&program, "x"));
            assert_eq!(read_map(&map), Ok(EarlierLayout::from(&*program.layout)));
        }
    }

    #[test]
    fn one_variable_more_moves_no_other() {
        let old = program(&SLOTS, None);
        let earlier = read_map(&Source::new("map", write_map(&old, "x"))).unwrap();
        let mut slots = SLOTS.to_vec();
        slots.insert(1, ("stop", Elementary::Bool, Area::Input));
        let new = program(&slots, Some(&earlier));
        let offsets: Vec<(&str, u32)> =
            new.layout.slots().iter().map(|slot| (slot.name.as_str(), slot.offset)).collect();
        assert_eq!(offsets, [("start", 0), ("stop", old.layout.size()), ("lamp", 2), ("delay", 8)]);
        // A second edit, on the map of the first.
        let earlier = read_map(&Source::new("map", write_map(&new, "x"))).unwrap();
        slots.push(("late", Elementary::Int, Area::Memory));
        let newest = program(&slots, Some(&earlier));
        assert_eq!(newest.layout.slots()[4].offset, new.layout.size());
        assert_eq!(newest.layout.slots()[1], new.layout.slots()[1]);
    }

    #[test]
    fn maps_that_cannot_be_are_refused() {
        let good = write_map(&program(&SLOTS, None), "x");
        let cases = [
            ("\"version\": 1", "\"version\": 2", "this map has version 2, but 1 is the one that is known"),
            ("\"offset\": 8", "\"offset\": 9", "this map tells an image that cannot be: `delay` cannot lie at 9"),
            ("\"offset\": 8", "\"offset\": 0", "`delay` at 0 is not an input, unlike the run that it lies in"),
            ("\"TIME\"", "\"TEA\"", "`delay` is `TEA`, which is not known"),
            ("\"state\"", "\"estate\"", "`delay` is `estate`, which is not known"),
            ("\"size\": ", "\"size\": 1", "an image cannot have "),
            ("\"size\": ", "\"size\": 99999999", "this is no map: invalid value"),
            ("\"offset\": 8", "\"offset\": -8", "this is no map: invalid value"),
            ("\"slots\"", "\"slot\"", "this is no map: missing field `slots`"),
            ("{", "[", "this is no map: "),
        ];
        for (from, to, expected) in cases {
            let fault = read_map(&Source::new("map", good.replacen(from, to, 1))).unwrap_err();
            assert_eq!(fault.code, Code::BadMap);
            assert!(fault.message.contains(expected), "{} lacks {expected}", fault.message);
        }
    }

    #[test]
    fn a_deep_file_is_refused() {
        let text = format!("{{\"slots\": {}", "[".repeat(100_000));
        assert_eq!(read_map(&Source::new("map", text)).unwrap_err().code, Code::BadMap);
    }

    proptest! {
        #[test]
        fn any_text_gives_a_layout_or_a_diagnostic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            let text = String::from_utf8_lossy(&bytes);
            prop_assert!(read_map(&Source::new("map", text)).is_err());
        }

        #[test]
        fn a_damaged_map_is_refused_or_can_be_extended(at in any::<prop::sample::Index>(), paste in "[0-9,]{0,3}") {
            let mut text = write_map(&program(&SLOTS, None), "x");
            let at = at.index(text.len() - 3);
            text.replace_range(at..at + 2, &paste);
            if let Ok(earlier) = read_map(&Source::new("map", text)) {
                let mut layout = LayoutBuilder::new();
                for name in ["start", "lamp", "new"] {
                    let (name, ty, initial) = (name.to_owned(), Elementary::Int, Value::default_of(Elementary::Int));
                    layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::Output, retain: true, initial, line: 0 });
                }
                if let Ok(layout) = layout.finish(Some(&earlier)) {
                    prop_assert_eq!(layout.problems(), Vec::<String>::new());
                }
            }
        }
    }
}
