//! The elements of a body, their wires, and where they stand: in rows from top to bottom, left to right in each.

use super::xml::Xml;

/// How far pins of a box are apart, and the first is below its top.
const PIN: i32 = 20;
const FIRST_PIN: i32 = 30;
/// The height of a contact, coil or variable.
const HEIGHT: i32 = 20;

/// Where a wire comes from: an element, and of a box the output, by its place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Source {
    pub(super) id: usize,
    pub(super) output: usize,
}

/// The wires that come together at a point: the power there is the OR of theirs.
pub(super) type Point = Vec<Source>;

/// A pin of a box that takes something.
pub(super) struct Input {
    pub(super) name: String,
    pub(super) wires: Point,
}

/// What an element is.
pub(super) enum Shape {
    LeftRail,
    /// With its attributes.
    Contact {
        variable: String,
        attributes: &'static [(&'static str, &'static str)],
    },
    Coil {
        variable: String,
        attributes: &'static [(&'static str, &'static str)],
    },
    Block {
        name: String,
        instance: Option<String>,
        inputs: Vec<Input>,
        in_outs: Vec<Input>,
        outputs: Vec<String>,
    },
    InVariable(String),
    OutVariable(String),
    Jump(String),
    Return,
    Label(String),
    Comment(String),
}

struct Element {
    shape: Shape,
    wires: Point,
    row: usize,
    x: i32,
    /// How far its line is below that of the row.
    down: i32,
}

/// How far a row reaches above and below its line.
#[derive(Clone, Copy)]
struct Row {
    above: i32,
    below: i32,
}

/// The elements of a body.
#[derive(Default)]
pub(super) struct Drawing {
    elements: Vec<Element>,
    rows: Vec<Row>,
}

/// The width that a text takes.
pub(super) fn width_of(text: &str) -> i32 {
    i32::try_from(text.chars().count().min(1000)).unwrap_or(0) * 8 + 10
}

impl Shape {
    pub(super) fn width(&self) -> i32 {
        match self {
            Self::LeftRail => 10,
            Self::Contact { .. } | Self::Coil { .. } => 21,
            Self::Block { name, instance, inputs, in_outs, outputs } => {
                let pins = inputs.iter().chain(in_outs).map(|input| width_of(&input.name)).max().unwrap_or(0)
                    + outputs.iter().map(|output| width_of(output)).max().unwrap_or(0);
                pins.max(width_of(name)).max(instance.as_ref().map_or(0, |name| width_of(name)))
            }
            Self::InVariable(text) | Self::OutVariable(text) | Self::Jump(text) | Self::Label(text) => width_of(text),
            Self::Return => 40,
            Self::Comment(text) => width_of(text).max(100),
        }
    }

    /// How many pins stand one below the other.
    pub(super) fn pins(&self) -> i32 {
        match self {
            Self::Block { inputs, in_outs, outputs, .. } => {
                i32::try_from((inputs.len() + in_outs.len()).max(outputs.len()).max(1)).unwrap_or(1)
            }
            _ => 1,
        }
    }

    fn height(&self) -> i32 {
        match self {
            Self::Block { .. } => FIRST_PIN + PIN * self.pins(),
            Self::LeftRail => 2 * HEIGHT,
            _ => HEIGHT,
        }
    }

    /// How far the line of its first pin is below its top.
    fn line(&self) -> i32 {
        match self {
            Self::Block { .. } => FIRST_PIN,
            Self::LeftRail => HEIGHT,
            _ => HEIGHT / 2,
        }
    }
}

impl Drawing {
    /// Starts a row below the others, so far below them.
    pub(super) fn row(&mut self, apart: i32) -> usize {
        self.rows.push(Row { above: HEIGHT + apart, below: HEIGHT });
        self.rows.len() - 1
    }

    /// Puts an element into a row, `down` pins below its line.
    pub(super) fn add(&mut self, shape: Shape, wires: Point, row: usize, x: i32, down: i32) -> usize {
        let down = down * PIN;
        if let Some(of) = self.rows.get_mut(row) {
            of.above = of.above.max(shape.line() + HEIGHT - down);
            of.below = of.below.max(down + shape.height() - shape.line());
        }
        self.elements.push(Element { shape, wires, row, x, down });
        self.elements.len() - 1
    }

    /// The `localId` of an element.
    pub(super) fn local_id(element: usize) -> u64 {
        element as u64 + 1
    }

    /// Writes the body as `<LD>`.
    pub(super) fn write(&self, xml: &mut Xml) {
        let mut lines = Vec::with_capacity(self.rows.len());
        let mut y = 0i32;
        for row in &self.rows {
            y = y.saturating_add(row.above).saturating_add(9) / 10 * 10;
            lines.push(y);
            y = y.saturating_add(row.below);
        }
        let page = Page { drawing: self, lines };
        xml.element("LD", &[], |xml| (0..self.elements.len()).for_each(|element| page.element(xml, element)));
    }
}

struct Page<'d> {
    drawing: &'d Drawing,
    /// The height of each row's line.
    lines: Vec<i32>,
}

impl Page<'_> {
    fn line(&self, element: &Element) -> i32 {
        self.lines.get(element.row).copied().unwrap_or(0).saturating_add(element.down)
    }

    fn element(&self, xml: &mut Xml, place: usize) {
        let element = &self.drawing.elements[place];
        let shape = &element.shape;
        let [id, width, height] =
            [Drawing::local_id(place).to_string(), shape.width().to_string(), shape.height().to_string()];
        let size = [("localId", id.as_str()), ("height", height.as_str()), ("width", width.as_str())];
        let with = |more: &[(&'static str, &str)]| -> Vec<(&'static str, String)> {
            size.iter().chain(more).map(|(name, value)| (*name, (*value).to_owned())).collect()
        };
        let (name, attributes) = match shape {
            Shape::LeftRail => ("leftPowerRail", with(&[])),
            Shape::Contact { attributes, .. } => ("contact", with(attributes)),
            Shape::Coil { attributes, .. } => ("coil", with(attributes)),
            Shape::Block { name, instance, .. } => {
                let mut more = vec![("typeName", name.as_str())];
                more.extend(instance.as_ref().map(|instance| ("instanceName", instance.as_str())));
                ("block", with(&more))
            }
            Shape::InVariable(_) => ("inVariable", with(&[("negated", "false")])),
            Shape::OutVariable(_) => ("outVariable", with(&[("negated", "false")])),
            Shape::Jump(label) => ("jump", with(&[("label", label)])),
            Shape::Return => ("return", with(&[])),
            Shape::Label(label) => ("label", with(&[("label", label)])),
            Shape::Comment(_) => ("comment", with(&[])),
        };
        let attributes: Vec<(&str, &str)> = attributes.iter().map(|(name, value)| (*name, value.as_str())).collect();
        let top = self.line(element).saturating_sub(shape.line());
        xml.element(name, &attributes, |xml| {
            xml.position("position", element.x, top);
            self.inside(xml, element);
        });
    }

    fn inside(&self, xml: &mut Xml, element: &Element) {
        let shape = &element.shape;
        let (width, line) = (shape.width(), shape.line());
        let right = |xml: &mut Xml, pin: i32| xml.position("relPosition", width, line + pin * PIN);
        match shape {
            Shape::LeftRail => {
                xml.on_one_line("connectionPointOut", &[("formalParameter", "")], |xml| right(xml, 0));
            }
            Shape::Contact { variable, .. } | Shape::Coil { variable, .. } => {
                self.point(xml, element, &element.wires, 0);
                xml.on_one_line("connectionPointOut", &[], |xml| right(xml, 0));
                xml.text("variable", variable);
            }
            Shape::Block { inputs, in_outs, outputs, .. } => {
                let mut pin = 0;
                for (list, inputs) in [("inputVariables", inputs), ("inOutVariables", in_outs)] {
                    if inputs.is_empty() {
                        xml.empty(list, &[]);
                        continue;
                    }
                    xml.element(list, &[], |xml| {
                        for input in inputs {
                            xml.element("variable", &[("formalParameter", &input.name)], |xml| {
                                self.point(xml, element, &input.wires, pin);
                            });
                            pin += 1;
                        }
                    });
                }
                xml.element("outputVariables", &[], |xml| {
                    for (pin, output) in (0..).zip(outputs) {
                        xml.element("variable", &[("formalParameter", output)], |xml| {
                            xml.on_one_line("connectionPointOut", &[], |xml| right(xml, pin));
                        });
                    }
                });
            }
            Shape::InVariable(text) => {
                xml.on_one_line("connectionPointOut", &[], |xml| right(xml, 0));
                xml.text("expression", text);
            }
            Shape::OutVariable(text) => {
                self.point(xml, element, &element.wires, 0);
                xml.text("expression", text);
            }
            Shape::Jump(_) | Shape::Return => self.point(xml, element, &element.wires, 0),
            Shape::Label(_) => {}
            Shape::Comment(text) => xml.formatted("content", text),
        }
    }

    /// A pin with its wires, each drawn from the pin back to where it comes from.
    fn point(&self, xml: &mut Xml, element: &Element, wires: &[Source], pin: i32) {
        let write = |xml: &mut Xml| {
            xml.position("relPosition", 0, element.shape.line() + pin * PIN);
            let end = (element.x, self.line(element) + pin * PIN);
            for wire in wires {
                let from = &self.drawing.elements[wire.id];
                let output = i32::try_from(wire.output).unwrap_or(0);
                let start = (from.x + from.shape.width(), self.line(from) + output * PIN);
                let id = Drawing::local_id(wire.id).to_string();
                let mut attributes = vec![("refLocalId", id.as_str())];
                if let Shape::Block { outputs, .. } = &from.shape {
                    attributes.extend(outputs.get(wire.output).map(|name| ("formalParameter", name.as_str())));
                }
                xml.on_one_line("connection", &attributes, |xml| {
                    xml.position("position", end.0, end.1);
                    if end.1 != start.1 {
                        // Close to where it starts, so that wires to one element share what is left.
                        let bend = start.0.saturating_add(10).min(end.0);
                        xml.position("position", bend, end.1);
                        xml.position("position", bend, start.1);
                    }
                    xml.position("position", start.0, start.1);
                });
            }
        };
        // With one wire at the most, as nearly all pins have, all of it is short.
        match wires.len() {
            0 | 1 => xml.on_one_line("connectionPointIn", &[], write),
            _ => xml.element("connectionPointIn", &[], write),
        }
    }
}
