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
    ];
    for text in texts {
        print_and_check(&parse_well(text));
    }
}
