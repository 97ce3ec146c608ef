//! Comments survive printing, beside what they stood beside.

use super::{parse_well, print_and_check};

#[test]
fn comments_print_where_they_stood() {
    let text = "\
-- The plant.
-----------------
program p  -- its name

-- The panel.
input  start, stop  -- buttons
output pump

-- Memory.
var    runs : INT  -- since the overhaul
-- at the end of the declarations

-- How it starts.
rung r1 \"title\"  -- the header
  -- before the first
  start  -- the button
  -- both
  [
    -- upper
    start  -- again
  | pump
    -- the last of the branch
  ]  -- closed
  t1:TON(  -- a timer
    PT := T#1s,  -- preset
    -- the elapsed time
    ET => x
    -- no more
  )  -- done
  (pump)
  -- before the bar
| stop  -- a second branch

-- The end.
";
    // What stands last in the declarations belongs to the rung behind them.
    let printed =
        text.replace("-- at the end of the declarations\n\n-- How", "\n-- at the end of the declarations\n-- How");
    assert_eq!(print_and_check(&parse_well(text)), printed);
}

#[test]
fn comments_of_types_units_and_statements_print_where_they_stood() {
    let text = "\
-- Colours.
type colour : (  -- of the lamp
  red,  -- stop
  -- go
  green := 4
) := red

type point : struct  -- a place
  x : REAL  -- metres
  -- and
  y : REAL
  -- no more
end_struct

-- The machine.
registers(hreg := 64)  -- few

global total : DINT  -- of all

-- The quick one.
task fast(interval := T#10ms)  -- often

-- What is done.
program control with fast  -- always

rung
  {  -- first
    x := 1;  -- one
    -- then
    IF a THEN  -- if so
      y := 2;  -- two
    ELSE
      -- if not
      z := 3;
      -- before the end
    END_IF;  -- done
    CASE n OF  -- which
      1, 2:  -- low
        y := 2;
      -- high
      3..5:
        y := 3;  -- three
    ELSE
      y := 4;
    END_CASE;
    -- nothing more
  }  -- behind

-- Computes.
function f : INT  -- a number

rung
  {f := 1;}  -- always one

-- Once more.
program again : control  -- the same
";
    assert_eq!(print_and_check(&parse_well(text)), text);
}

#[test]
fn comments_in_odd_places_are_kept_in_order() {
    let texts = [
        "-- only",
        "program -- a\n p -- b\n",
        "input -- a\n x -- b\n , -- c\n y -- d\n : -- e\n BOOL -- f\n -- g\n at -- h\n %IX0.0 -- i\n",
        "rung -- a\n \"t\" -- b\n",
        "rung off -- a\n",
        "rung\n[ -- a\n | -- b\n | -- c\n ] -- d\n -- e\n (x)",
        "rung\n a | -- a\n | -- b\n b -- c\n | -- d\n",
        "rung\n ( -- a\n S -- b\n x -- c\n ) -- d\n { -- e\n a -- f\n + -- g\n b -- h\n} -- i\n",
        "rung\n t( -- a\n ) -- b\n . -- c\n Q -- d\n",
        "rung\n t:T(a -- a\n := -- b\n [ -- c\n ] -- d\n , -- e\n b => c -- f\n ) -- g\n .Q",
        "rung\n > -- a\n n -- b\n > -- c\n | - -- d\n > n >",
        "rung\n [ { a -- in braces\n } | b ] (c)",
        "rung\n a\n -- own\n | -- behind\n b",
        "type -- a\n t -- b\n : -- c\n ( -- d\n a -- e\n := -- f\n 1 -- g\n , -- h\n b -- i\n ) -- j\n := -- k\n a -- l\n",
        "type t : struct -- a\n x -- b\n , -- c\n y -- d\n : -- e\n INT -- f\n end_struct -- g\n type u : INT",
        "registers -- a\n ( -- b\n ) -- c\n global -- d\n const -- e\n x -- f\n task -- g\n t -- h\n ( -- i\n ) -- j\n",
        "program p -- a\n with -- b\n t -- c\n program q -- d\n : -- e\n p -- f\n",
        "rung\n { -- a\n IF -- b\n a -- c\n THEN -- d\n ELSIF -- e\n b -- f\n THEN -- g\n c := 1 -- h\n ; -- i\n ELSE -- j\n d -- k\n ( -- l\n x -- m\n ) -- n\n ; -- o\n END_IF -- p\n ; -- q\n } -- r\n",
        "rung\n {f( -- a\n x -- b\n , -- c\n y => z -- d\n );} {f( -- e\n x -- f\n )} {x := -- g\n 1 -- h\n } {x -- i\n := 1; -- j\n}",
        "rung\n {CASE -- a\n x OF -- b\n 1 -- c\n .. -- d\n 2 -- e\n , -- f\n 3 -- g\n : -- h\n 4: -- i\n EXIT; -- j\n ELSE -- k\n END_CASE -- l\n}",
    ];
    for text in texts {
        print_and_check(&parse_well(text));
    }
}

#[test]
fn comments_between_the_arguments_of_a_statement_stay_there() {
    let text = "\
program p

rung r1
  { t1(
      IN := a,  -- beside IN
      -- before PT
      PT := T#2s
      -- the last of all
    );
    -- before the next
    t1(IN := a, PT := T#2s);  -- behind it
  }
";
    assert_eq!(print_and_check(&parse_well(text)), text);
}
