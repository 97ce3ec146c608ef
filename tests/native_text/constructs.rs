//! What each construct means: text to model.

use rung::elementary::Elementary;
use rung::ladder::*;

use super::{parse, parse_well};

/// The elements of the only branch of a rung with this body.
fn elements(body: &str) -> Vec<ElementKind> {
    let mut program = parse_well(&format!("rung\n{body}"));
    let mut branches = program.units[0].rungs.remove(0).circuit.branches;
    assert_eq!(branches.len(), 1, "{body}");
    branches.remove(0).elements.into_iter().map(|element| element.kind).collect()
}

/// The only element of a rung.
fn element(body: &str) -> ElementKind {
    let mut elements = elements(body);
    assert_eq!(elements.len(), 1, "{body}: {elements:?}");
    elements.remove(0)
}

/// A contact or coil in short: its kind, what it starts at, and its steps.
fn brief(kind: &ElementKind) -> String {
    match kind {
        ElementKind::Contact { kind, operand } => match &operand.kind {
            ExpressionKind::Read(reference) => format!("{kind:?} {}", reference_brief(reference)),
            ExpressionKind::Literal(Literal::Bool(value)) => format!("{kind:?} {value}"),
            other => panic!("{other:?}"),
        },
        ElementKind::Coil { kind, target } => format!("({kind:?} {})", reference_brief(target)),
        ElementKind::Block(call) => format!(
            "block {}:{}/{}.{}",
            reference_brief(&call.instance),
            call.type_name.as_ref().map_or("", |name| &name.text),
            call.arguments.len(),
            call.power_output.as_ref().map_or("", |name| &name.text)
        ),
        ElementKind::Condition(_) => "condition".to_owned(),
        ElementKind::Statements(statements) => {
            let statements: Vec<String> = statements.iter().map(statement_brief).collect();
            format!("{{{}}}", statements.join(" "))
        }
        ElementKind::Jump { target } => format!("jump {}", target.text),
        ElementKind::Return => "return".to_owned(),
        ElementKind::Assignment { target, .. } => format!("assign {}", reference_brief(target)),
        ElementKind::Parallel(circuit) => {
            let branches: Vec<String> =
                circuit.branches.iter().map(|branch| briefs(branch.elements.iter().map(|e| &e.kind))).collect();
            format!("[{}]", branches.join("|"))
        }
    }
}

/// A statement in short.
fn statement_brief(statement: &Statement) -> String {
    let body = |body: &[Statement]| body.iter().map(statement_brief).collect::<Vec<_>>().join(" ");
    match &statement.kind {
        StatementKind::Assignment { target, value } => format!("{} := {};", reference_brief(target), grouped(value)),
        StatementKind::Call(call) => {
            let argument = |argument: &Argument| match &argument.wire {
                Wire::Value(value) => format!("{}: {}", argument.pin.text, grouped(value)),
                Wire::Output(target) => format!("{} > {}", argument.pin.text, reference_brief(target)),
                Wire::Circuit(_) => panic!("a circuit in a statement"),
            };
            let arguments: Vec<String> = call.arguments.iter().map(argument).collect();
            format!("call {}<{}>;", reference_brief(&call.instance), arguments.join(", "))
        }
        StatementKind::If { branches, otherwise } => {
            let branch =
                |branch: &ConditionalBranch| format!("if {} ({})", grouped(&branch.condition), body(&branch.body));
            let branches: Vec<String> = branches.iter().map(branch).collect();
            format!("{} else ({})", branches.join(" "), body(otherwise))
        }
        StatementKind::Case { selector, branches, otherwise } => {
            let label = |label: &CaseLabel| match &label.last {
                Some(last) => format!("{}..{}", grouped(&label.first), grouped(last)),
                None => grouped(&label.first),
            };
            let branch = |branch: &CaseBranch| {
                let labels: Vec<String> = branch.labels.iter().map(label).collect();
                format!("on {} ({})", labels.join(" "), body(&branch.body))
            };
            let branches: Vec<String> = branches.iter().map(branch).collect();
            format!("case {} {} else ({})", grouped(selector), branches.join(" "), body(otherwise))
        }
        StatementKind::For { variable, first, last, step, body: repeated } => format!(
            "for {} {} {} {} ({})",
            reference_brief(variable),
            grouped(first),
            grouped(last),
            step.as_ref().map_or(String::new(), grouped),
            body(repeated)
        ),
        StatementKind::Exit => "exit;".to_owned(),
        StatementKind::Return => "return;".to_owned(),
    }
}

fn briefs<'a>(kinds: impl Iterator<Item = &'a ElementKind>) -> String {
    kinds.map(brief).collect::<Vec<_>>().join(", ")
}

fn reference_brief(reference: &Reference) -> String {
    let mut text = match &reference.root {
        Root::Name(name) => name.text.to_string(),
        Root::Address(address) => format!("{:?}{:?}{:?}", address.area, address.width, address.numbers),
    };
    for step in &reference.steps {
        match step {
            Step::Member(name) => text.push_str(&format!(".{}", name.text)),
            Step::Bit(bit, _) => text.push_str(&format!("#{bit}")),
            Step::Index(indices, _) => {
                let indices: Vec<String> = indices.iter().map(grouped).collect();
                text.push_str(&format!("[{}]", indices.join(" ")));
            }
        }
    }
    text
}

#[test]
fn every_contact_coil_and_shape_of_element() {
    let cases = [
        ("a", "Open a"),
        ("/a", "Closed a"),
        ("^a", "Rising a"),
        ("^/a", "Falling a"),
        ("^ / a", "Falling a"),
        ("TRUE /false", "Open true, Closed false"),
        ("%IX0.3 /%q7 ^%MW2.5", "Open InputBit[0, 3], Closed OutputBit[7], Rising MemoryWord[2, 5]"),
        ("w.3 delay.Q /w.31 a.b.2", "Open w#3, Open delay.Q, Closed w#31, Open a.b#2"),
        ("`a b` größe", "Open a b, Open größe"),
        ("(a)", "(Plain a)"),
        ("(/a)", "(Negated a)"),
        ("(S a) (R a) (P a) (N a)", "(Set a), (Reset a), (Rising a), (Falling a)"),
        ("(s a) (r a) (p %QX1.0) (n w.3)", "(Set a), (Reset a), (Rising OutputBit[1, 0]), (Falling w#3)"),
        (
            "(s) (R) (p.3) (`S`) (S s) (%QW3)",
            "(Plain s), (Plain R), (Plain p#3), (Plain S), (Set s), (Plain OutputWord[3])",
        ),
        ("[ a | b ]", "[Open a|Open b]"),
        ("[ a | ] [ | ] []", "[Open a|], [|], []"),
        ("[ [ a | b ] c | d (e) ]", "[[Open a|Open b], Open c|Open d, (Plain e)]"),
        ("{a > 1} {x := 2} {(x) := 3}", "condition, assign x, assign x"),
        ("t1()", "block t1:/0."),
        ("t1(PT := T#1s)", "block t1:/1."),
        ("t1:TON(PT := T#1s, ET => x).Q", "block t1:TON/2.Q"),
        ("t1 : TON()", "block t1:TON/0."),
        ("t1 (x)", "Open t1, (Plain x)"),
        ("t1\n(x)", "Open t1, (Plain x)"),
        ("t1.Q (x) w.3(x) %IX0.1(x)", "Open t1.Q, (Plain x), Open w#3, (Plain x), Open InputBit[0, 1], (Plain x)"),
        (
            "a[i] a[i+1, 2].x /a[b[c]] (S a [3]) (s[1])",
            "Open a[i], Open a[(i + 1) 2].x, Closed a[b[c]], (Set a[3]), (Plain s[1])",
        ),
        ("a [ i | j ]", "Open a, [Open i|Open j]"),
        (
            "timers[3](PT := x) fb.t1() fb.t[i].u(Q => z).Q",
            "block timers[3]:/1., block fb.t1:/0., block fb.t[i].u:/1.Q",
        ),
        ("AND(IN1 := a) Mod() NOT(IN := a).OUT", "block AND:/1., block Mod:/0., block NOT:/1.OUT"),
        ("{f(x)} {f(x);} {AND(a, b)} {x := 1;} {;}", "condition, {call f<: x>;}, condition, {x := 1;}, {}"),
        (
            "{t.u(IN := a, 5, Q => b[1]); exit; RETURN; ; %QW3 := 5;}",
            "{call t.u<IN: a, : 5, Q > b[1]>; exit; return; OutputWord[3] := 5;}",
        ),
        ("/t1(x)", "Closed t1, (Plain x)"),
        ("c:CTU(R := [ a | b ], PV := 10 + n)", "block c:CTU/2."),
    ];
    for (body, expected) in cases {
        assert_eq!(briefs(elements(body).iter()), expected, "{body}");
    }
}

#[test]
fn a_block_keeps_its_wires_in_order() {
    let ElementKind::Block(call) = element("c:CTUD(R := [ a /b | c ], PV := 10, CV => w.3).QD") else { panic!() };
    assert_eq!((reference_brief(&call.instance).as_str(), call.type_name.unwrap().text.as_str()), ("c", "CTUD"));
    assert_eq!(call.power_output.unwrap().text, "QD");
    let [reset, preset, count] = call.arguments.try_into().unwrap();
    assert_eq!([&reset.pin.text, &preset.pin.text, &count.pin.text], ["R", "PV", "CV"]);
    let Wire::Circuit(circuit) = reset.wire else { panic!() };
    assert_eq!(brief(&ElementKind::Parallel(circuit)), "[Open a, Closed b|Open c]");
    let Wire::Value(Expression { kind: ExpressionKind::Literal(value), .. }) = preset.wire else { panic!() };
    assert_eq!(value, Literal::Integer { value: 10.into(), base: 10, ty: None });
    let Wire::Output(target) = count.wire else { panic!() };
    assert_eq!(reference_brief(&target), "w#3");
}

/// The literal in `{…}`.
fn literal(text: &str) -> Literal {
    match element(&format!("{{{text}}}")) {
        ElementKind::Condition(Expression { kind: ExpressionKind::Literal(literal), .. }) => literal,
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn every_form_of_literal() {
    let integer = |value: u128, base, ty| Literal::Integer { value: value.into(), base, ty };
    let real = |value, ty| Literal::Real { value, ty };
    let cases = [
        ("12", integer(12, 10, None)),
        ("1_000", integer(1000, 10, None)),
        ("16#Ff", integer(255, 16, None)),
        ("2#10_10", integer(10, 2, None)),
        ("8#17", integer(15, 8, None)),
        ("10#17", integer(17, 10, None)),
        ("INT#5", integer(5, 10, Some(Elementary::Int))),
        ("int#+5", integer(5, 10, Some(Elementary::Int))),
        ("WORD#16#FF", integer(255, 16, Some(Elementary::Word))),
        ("BOOL#1", integer(1, 10, Some(Elementary::Bool))),
        ("340282366920938463463374607431768211455", integer(u128::MAX, 10, None)),
        ("BOOL#False", Literal::Bool(false)),
        ("true", Literal::Bool(true)),
        ("1.5", real(1.5, None)),
        ("1.0e-3", real(0.001, None)),
        ("1.0E+3", real(1000.0, None)),
        ("1_0.2_5", real(10.25, None)),
        ("REAL#2.5", real(2.5, Some(Elementary::Real))),
        ("LREAL#2", real(2.0, Some(Elementary::Lreal))),
        ("T#1h2m3s4ms5us6ns", Literal::Time(3_723_004_005_006)),
        ("TIME#1.5s", Literal::Time(1_500_000_000)),
        ("t#-5s", Literal::Time(-5_000_000_000)),
        ("T#1d", Literal::Time(86_400_000_000_000)),
        ("T#1D_2H", Literal::Time(93_600_000_000_000)),
        ("T#90m", Literal::Time(5_400_000_000_000)),
        ("T#0.25us", Literal::Time(250)),
        ("T#9223372036854775807ns", Literal::Time(i64::MAX)),
        ("T#-9223372036854775808ns", Literal::Time(i64::MIN)),
    ];
    for (text, expected) in cases {
        assert_eq!(literal(text), expected, "{text}");
    }
}

#[test]
fn a_sign_behind_a_type_is_an_operator() {
    let ElementKind::Condition(Expression { kind: ExpressionKind::Unary(UnaryOperator::Negate, operand), .. }) =
        element("{INT#-5}")
    else {
        panic!()
    };
    let expected = Literal::Integer { value: 5.into(), base: 10, ty: Some(Elementary::Int) };
    assert_eq!(operand.kind, ExpressionKind::Literal(expected));
}

/// An expression with all its parentheses.
fn grouped(expression: &Expression) -> String {
    match &expression.kind {
        ExpressionKind::Read(reference) => reference_brief(reference),
        ExpressionKind::Unary(UnaryOperator::Not, operand) => format!("(NOT {})", grouped(operand)),
        ExpressionKind::Unary(UnaryOperator::Negate, operand) => format!("(-{})", grouped(operand)),
        ExpressionKind::Binary(operator, left, right) => {
            format!("({} {} {})", grouped(left), operator.symbol(), grouped(right))
        }
        ExpressionKind::Literal(Literal::Enumerated { ty, value }) => format!("{}#{}", ty.text, value.text),
        ExpressionKind::Literal(Literal::Integer { value, base: 10, ty: None }) => value.get().to_string(),
        ExpressionKind::Literal(literal) => format!("{literal:?}"),
        ExpressionKind::Call { function, arguments } => {
            let argument = |argument: &FunctionArgument| match &argument.parameter {
                Some(parameter) => format!("{}: {}", parameter.text, grouped(&argument.value)),
                None => grouped(&argument.value),
            };
            let arguments: Vec<String> = arguments.iter().map(argument).collect();
            format!("{}<{}>", function.text, arguments.join(", "))
        }
        ExpressionKind::Array(items) => {
            let value = |value: &Option<Expression>| value.as_ref().map_or(String::new(), grouped);
            let item = |item: &ArrayItem| match &item.repeat {
                Some(repeat) => format!("{} x {}", grouped(repeat), value(&item.value)),
                None => value(&item.value),
            };
            format!("[{}]", items.iter().map(item).collect::<Vec<_>>().join(", "))
        }
        ExpressionKind::Structure(members) => {
            let member = |member: &MemberValue| format!("{}: {}", member.member.text, grouped(&member.value));
            format!("({})", members.iter().map(member).collect::<Vec<_>>().join(", "))
        }
    }
}

#[test]
fn names_before_parentheses_call_functions() {
    let cases = [
        ("limit(a, b + c, -d)", "limit<a, (b + c), (-d)>"),
        ("SEL(G := a, IN1 := b, IN0 := c OR d)", "SEL<G: a, IN1: b, IN0: (c OR d)>"),
        ("SQRT (a) > ABS(MIN(a, b))", "(SQRT<a> > ABS<MIN<a, b>>)"),
        ("f()", "f<>"),
        ("`my f`(`a b` := a)", "my f<a b: a>"),
        ("AND(a, b) and or(c, d) = xor(e, f) MOD MOD(a, b)", "(AND<a, b> AND (or<c, d> = (xor<e, f> MOD MOD<a, b>)))"),
        ("NOT(a) + `NOT`(b)", "((NOT a) + NOT<b>)"),
        ("`NOT`(a)", "NOT<a>"),
    ];
    for (text, expected) in cases {
        let ElementKind::Condition(expression) = element(&format!("{{{text}}}")) else { panic!("{text}") };
        assert_eq!(grouped(&expression), expected, "{text}");
    }
}

/// The statements in `{…}`.
fn statements(text: &str) -> Vec<String> {
    match element(&format!("{{{text}}}")) {
        ElementKind::Statements(statements) => statements.iter().map(statement_brief).collect(),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn every_statement() {
    let cases = [
        ("a.b[1] := c + 1;", "a.b[1] := (c + 1);"),
        ("t1(IN := a AND b, PT := T#1s, Q => c[2]);", "call t1<IN: (a AND b), PT: Time(1000000000), Q > c[2]>;"),
        ("MOD(a, 2, OUT => b);", "call MOD<: a, : 2, OUT > b>;"),
        ("`NOT`(EN := a, IN := b, ENO => c);", "call NOT<EN: a, IN: b, ENO > c>;"),
        ("a(); b[i].c();", "call a<>; call b[i].c<>;"),
        ("if a then b := 1; end_if", "if a (b := 1;) else ()"),
        (
            "IF a = 1 THEN EXIT; ELSIF b THEN ; ELSIF c THEN RETURN; ELSE d := 1; e := 2; END_IF;",
            "if (a = 1) (exit;) if b () if c (return;) else (d := 1; e := 2;)",
        ),
        (
            "CASE a + 1 OF 1: b := 1; 2, limit..limit + 2, -3: c := 1; d(); colour#red, red: ELSE e := 1; END_CASE;",
            "case (a + 1) on 1 (b := 1;) on 2 limit..(limit + 2) (-3) (c := 1; call d<>;) on colour#red red () else (e := 1;)",
        ),
        ("CASE a OF END_CASE;", "case a  else ()"),
        ("FOR i := 0 TO n - 1 DO a[i] := 0; END_FOR;", "for i 0 (n - 1)  (a[i] := 0;)"),
        ("FOR i := 9 TO 0 BY -1 DO IF a[i] THEN EXIT; END_IF; END_FOR;", "for i 9 0 (-1) (if a[i] (exit;) else ())"),
    ];
    for (text, expected) in cases {
        assert_eq!(statements(text).join(" "), expected, "{text}");
    }
}

#[test]
fn types_and_initial_values() {
    let program = parse_well(
        "type a : INT := 5\ntype b : array [0..9, -1..n] of a := [1, 2(3), 4((x := 1)), 5(), [6]]\n\
         type c : (red, green := 4) := green\ntype d : USINT (one, two)\n\
         type e : struct x, y : REAL := (1.5); z : c := c#red end_struct\nvar v : e := (x := 1.0, z := `c`#`red`)",
    );
    let ty = |ty: &TypeReference| {
        let bounds = |dimension: &Dimension| format!("{}..{} ", grouped(&dimension.first), grouped(&dimension.last));
        format!("{}{}", ty.dimensions.iter().map(bounds).collect::<String>(), ty.name.text)
    };
    let value =
        |value: &Option<Expression>| value.as_ref().map_or(String::new(), |value| format!(" := {}", grouped(value)));
    let brief: Vec<String> = program
        .types
        .iter()
        .map(|declaration| match &declaration.kind {
            TypeKind::Alias { ty: alias, initial } => format!("{}{}", ty(alias), value(initial)),
            TypeKind::Structure(fields) => {
                let field = |field: &Field| format!("{}: {}{};", field.name.text, ty(&field.ty), value(&field.initial));
                fields.iter().map(field).collect()
            }
            TypeKind::Enumeration { base, values, initial } => {
                let values = values.iter().map(|(name, number)| format!("{}{};", name.text, value(number)));
                format!("{base:?} {}{initial:?}", values.collect::<String>())
                    .replace(|c: char| c.is_ascii_digit() || c == '.', "")
            }
        })
        .collect();
    assert_eq!(
        brief,
        [
            "INT := 5",
            "0..9 (-1)..n a := [1, 2 x 3, 4 x (x: 1), 5 x , [6]]",
            "None red;green := ;Some(Name { text: \"green\", span:  })",
            "Some(Name { text: \"USINT\", span:  }) one;two;None",
            "x: REAL := Real { value: 1.5, ty: None };y: REAL := Real { value: 1.5, ty: None };z: c := c#red;",
        ]
    );
    let initial = program.units[0].variables[0].initial.as_deref().map(grouped);
    assert_eq!(initial.as_deref(), Some("(x: Real { value: 1.0, ty: None }, z: c#red)"));
}

#[test]
fn a_file_declares_units_tasks_and_instances() {
    let program = parse_well(
        "registers(ireg := 16, timers := n + 1)\nglobal a, b : INT\nglobal const c := 1\n\
         task fast(interval := 10ms, priority := 1)\ntask slow(interval := T#1s)\ntask idle\n\
         program main with fast\ninput i\nrung\n i\nprogram other\nfunction_block fb\ninout x : INT\ntemp y\n\
         rung\n x\nrung\n y\nfunction f : array [1..2] of INT\nfunction g\nprogram m1 : main with slow\nprogram m2 : main",
    );
    assert_eq!(program.name.text, "test", "of several programs none gives its name");
    let settings: Vec<String> = program
        .registers
        .iter()
        .flat_map(|registers| &registers.settings)
        .map(|setting| format!("{}: {}", setting.name.text, grouped(&setting.value)))
        .collect();
    assert_eq!(settings, ["ireg: 16", "timers: (n + 1)"]);
    let globals: Vec<_> =
        program.globals.iter().map(|variable| (variable.class, variable.name.text.as_str())).collect();
    use VariableClass::{Constant, InOut, Input, Memory, Temporary};
    assert_eq!(globals, [(Memory, "a"), (Memory, "b"), (Constant, "c")]);
    let tasks: Vec<String> = program
        .tasks
        .iter()
        .map(|task| {
            let value = |value: &Option<Expression>| value.as_ref().map_or("none".to_owned(), grouped);
            format!("{} {} {}", task.name.text, value(&task.interval), value(&task.priority))
        })
        .collect();
    assert_eq!(tasks, ["fast Time(10000000) 1", "slow Time(1000000000) none", "idle none none"]);
    let units: Vec<String> = program
        .units
        .iter()
        .map(|unit| {
            let kind = match &unit.kind {
                UnitKind::Program { task } => format!("program {}", task.as_ref().map_or("", |task| &task.text)),
                UnitKind::FunctionBlock => "block".to_owned(),
                UnitKind::Function { result } => format!("function {}", result.as_ref().map_or("", |ty| &ty.name.text)),
            };
            let classes: Vec<_> = unit.variables.iter().map(|variable| variable.class).collect();
            format!("{kind} {} {classes:?} {}", unit.name.text, unit.rungs.len())
        })
        .collect();
    assert_eq!(
        units,
        [
            format!("program fast main {:?} 1", [Input]),
            "program  other [] 0".to_owned(),
            format!("block fb {:?} 2", [InOut, Temporary]),
            "function INT f [] 0".to_owned(),
            "function  g [] 0".to_owned(),
        ]
    );
    let instances: Vec<_> = program
        .instances
        .iter()
        .map(|one| {
            (one.name.text.as_str(), one.program.text.as_str(), one.task.as_ref().map(|task| task.text.as_str()))
        })
        .collect();
    assert_eq!(instances, [("m1", "main", Some("slow")), ("m2", "main", None)]);
    assert_eq!(parse_well("function f\nprogram only").name.text, "only");
}

#[test]
fn operators_bind_as_the_standard_says() {
    let cases = [
        ("a OR b XOR c AND d", "(a OR (b XOR (c AND d)))"),
        ("a and b & c or d", "(((a AND b) AND c) OR d)"),
        ("a AND b = c < d + e * f", "(a AND (b = (c < (d + (e * f)))))"),
        ("a * b + c > d <> e AND f", "(((((a * b) + c) > d) <> e) AND f)"),
        ("a - b - c + d", "(((a - b) - c) + d)"),
        ("a / b MOD c * d", "(((a / b) MOD c) * d)"),
        ("NOT a = b", "((NOT a) = b)"),
        ("-a * -b", "((-a) * (-b))"),
        ("a - -b", "(a - (-b))"),
        ("NOT NOT -a", "(NOT (NOT (-a)))"),
        ("(a OR b) AND (c OR d)", "((a OR b) AND (c OR d))"),
        ("a <= b >= c", "((a <= b) >= c)"),
    ];
    for (text, expected) in cases {
        let ElementKind::Condition(expression) = element(&format!("{{{text}}}")) else { panic!("{text}") };
        assert_eq!(grouped(&expression), expected, "{text}");
    }
}

#[test]
fn declarations_take_their_clauses_in_any_order() {
    let program = parse_well(
        "program p\nINPUT a, b : BOOL\noutput c at %QX0.1\nvar t1 : TON retain\n\
         var d retain := 5 : INT at %MW3\nconst e := T#5s\nvar at, retain : at at %I3",
    );
    let brief: Vec<String> = program.units[0]
        .variables
        .iter()
        .map(|variable| {
            let type_name = variable.ty.as_ref().map_or("", |ty| &ty.name.text);
            let address = variable.address.as_ref().map(|address| &address.numbers);
            let initial = variable.initial.as_deref().map_or(String::new(), grouped);
            format!("{:?} {}:{type_name} {address:?} {initial} {}", variable.class, variable.name.text, variable.retain)
        })
        .collect();
    assert_eq!(
        brief,
        [
            "Input a:BOOL None  false",
            "Input b:BOOL None  false",
            "Output c: Some([0, 1])  false",
            "Memory t1:TON None  true",
            "Memory d:INT Some([3]) 5 true",
            "Constant e: None Time(5000000000) false",
            "Memory at:at Some([3])  false",
            "Memory retain:at Some([3])  false",
        ]
    );
}

#[test]
fn rungs_have_names_titles_and_states_or_not() {
    let program = parse_well(
        "rung r10 \"one $\"two$\" $$3$N\"\na\nrung \"t\" a\nrung r2\na\nrung\na (b)\nrung off r3 \"x\" a\nRUNG OFF\na\n\
         rung\noff\nrung `off`\nrung /a (b)\nrung r9 -- comment\na",
    );
    let brief: Vec<_> = program.units[0]
        .rungs
        .iter()
        .map(|rung| {
            (
                rung.name.as_ref().map(|name| name.text.as_str()),
                rung.title.as_deref(),
                rung.enabled,
                briefs(rung.circuit.branches[0].elements.iter().map(|element| &element.kind)),
            )
        })
        .collect();
    let open = || "Open a".to_owned();
    assert_eq!(
        brief,
        [
            (Some("r10"), Some("one \"two\" $3\n"), true, open()),
            (None, Some("t"), true, open()),
            (Some("r2"), None, true, open()),
            (None, None, true, "Open a, (Plain b)".to_owned()),
            (Some("r3"), Some("x"), false, open()),
            (None, None, false, open()),
            (None, None, true, "Open off".to_owned()),
            (Some("off"), None, true, String::new()),
            (None, None, true, "Closed a, (Plain b)".to_owned()),
            (Some("r9"), None, true, open()),
        ]
    );
}

#[test]
fn branches_start_and_end_at_nodes() {
    let program = parse_well("rung\na >x> | >x> b >y> | - >x> | >x> >y> | >y> | c (d) | ");
    let brief: Vec<_> = program.units[0].rungs[0]
        .circuit
        .branches
        .iter()
        .map(|branch| {
            let node = |name: &Option<Box<Name>>| name.as_ref().map_or(String::new(), |name| name.text.to_string());
            (node(&branch.from), branch.elements.len(), node(&branch.to))
        })
        .collect();
    let expected = [("", 1, "x"), ("x", 1, "y"), ("", 0, "x"), ("x", 0, "y"), ("y", 0, ""), ("", 2, ""), ("", 0, "")];
    assert_eq!(brief, expected.map(|(from, elements, to)| (from.to_owned(), elements, to.to_owned())));
}

#[test]
fn a_file_without_a_program_line_is_named_after_itself() {
    let name = |file: &str| {
        let parsed = rung::frontend::native::parse(&rung::source::Source::new(file, ""));
        parsed.program.name.text
    };
    assert_eq!(name("plant/pump station.rung"), "pump station");
    assert_eq!(name("x"), "x");
    assert_eq!(name(""), "main");
    assert_eq!(parse_well("program `my plant`").name.text, "my plant");
}

#[test]
fn spans_cover_what_they_name() {
    let text = "var t1 : TON  retain\n\nrung r1 \"x\"\n  /a [ b | t1(PT := T#1s).Q ] ({c)";
    let text = &text.replace("({c)", "{c + (1)}");
    let (program, _) = parse(text);
    let slice = |span: rung::source::Span| &text[span.range()];
    assert_eq!(slice(program.units[0].variables[0].span), "var t1 : TON  retain");
    let rung = &program.units[0].rungs[0];
    assert_eq!(slice(rung.span), &text[text.find("rung").unwrap()..]);
    let elements = &rung.circuit.branches[0].elements;
    assert_eq!(slice(elements[0].span), "/a");
    assert_eq!(slice(elements[1].span), "[ b | t1(PT := T#1s).Q ]");
    let ElementKind::Parallel(circuit) = &elements[1].kind else { panic!() };
    assert_eq!(slice(circuit.span), slice(elements[1].span));
    assert_eq!(slice(circuit.branches[1].span), "t1(PT := T#1s).Q");
    let ElementKind::Condition(sum) = &elements[2].kind else { panic!() };
    assert_eq!(slice(sum.span), "c + (1)");
}

#[test]
fn comments_know_whether_they_stand_alone() {
    let program = parse_well("--a\ninput x -- b \n  --\tc\r\n--- d");
    let brief: Vec<_> = program.comments.iter().map(|comment| (comment.text.as_str(), comment.own_line)).collect();
    assert_eq!(brief, [("a", true), ("b", false), ("c", true), ("- d", true)]);
}

#[test]
fn two_arrows_jump_to_a_rung_or_return() {
    let text = briefs(elements("[ a >> r40 | >>R40 | >> `a b` ] >> Return").iter());
    assert_eq!(text, "[Open a, jump r40|jump R40|jump a b], return");
    assert_eq!(briefs(elements(">> `return`").iter()), "jump return");
    assert_eq!(briefs(elements(">> off").iter()), "jump off");
}
