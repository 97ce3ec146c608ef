# Turns a program's map (`rung build --map`) and its stimuli (the CSV of `rung sim`) into the tables of trace.h:
#
#     awk -v cycle_ms=100 -f tables.awk ladder.json traffic_light.stimuli.csv > tables.c
#
# The stimuli may be left out. Any fault ends with a message and the status 1; what was printed until then is no C.

function fail(message) {
    print "tables.awk: " message > "/dev/stderr"
    failed = 1
    exit 1
}

# Milliseconds in decimal as nanoseconds, by their digits: a double would lose some.
function nanoseconds(text,    sign, parts, fraction) {
    sign = text ~ /^-/ ? "-" : ""
    sub(/^[-+]/, "", text)
    if (text !~ /^[0-9]+(\.[0-9]+)?$/) fail("`" text "` is no time in milliseconds")
    split(text, parts, ".")
    fraction = parts[2]
    sub(/0+$/, "", fraction)
    if (length(fraction) > 6) fail("`" text "` has more than 6 decimals")
    while (length(fraction) < 6) fraction = fraction "0"
    text = parts[1] fraction
    sub(/^0+/, "", text)
    return sign (text == "" ? "0" : text)
}

# The cells of a line of CSV, into cells[1..]; gives how many. A cell may stand in quotes.
function csv(line,    count, cell) {
    count = 0
    do {
        if (match(line, /^[ \t]*"([^"]|"")*"[ \t]*/)) {
            cell = substr(line, 1, RLENGTH)
            gsub(/^[ \t]*"|"[ \t]*$/, "", cell)
            gsub(/""/, "\"", cell)
        } else {
            match(line, /^[^,]*/)
            cell = substr(line, 1, RLENGTH)
            gsub(/^[ \t]+|[ \t]+$/, "", cell)
        }
        cells[++count] = cell
        line = substr(line, RLENGTH + 1)
    } while (sub(/^,/, "", line))
    return count
}

# A value of a cell as the bits of its type.
function bits(type, text,    sign) {
    if (type == "BOOL") {
        if (text ~ /^(0|[Ff][Aa][Ll][Ss][Ee])$/) return "0u"
        if (text ~ /^(1|[Tt][Rr][Uu][Ee])$/) return "1u"
        fail("`" text "` is no BOOL")
    }
    if (type == "TIME") text = nanoseconds(text)
    sign = text ~ /^-/ ? "0u - " : ""
    sub(/^[-+]/, "", text)
    if (text !~ /^[0-9]+$/) fail("`" text "` is no integer")
    sub(/^0+/, "", text)
    return sign (text == "" ? "0" : text) "ull"
}

# A string as C has it; one from the map is so already, since C knows the escapes of JSON.
function name_in_header(name) {
    if (name !~ /[,"]/) return name
    gsub(/\\"/, "\\\"\\\"", name)
    return "\\\"" name "\\\""
}

BEGIN {
    size["BOOL"] = size["SINT"] = size["USINT"] = size["BYTE"] = 1
    size["INT"] = size["UINT"] = size["WORD"] = 2
    size["DINT"] = size["UDINT"] = size["DWORD"] = 4
    size["LINT"] = size["ULINT"] = size["LWORD"] = size["TIME"] = 8
    for (type in size) kind[type] = "TRACE_UNSIGNED"
    kind["SINT"] = kind["INT"] = kind["DINT"] = kind["LINT"] = "TRACE_SIGNED"
    kind["TIME"] = "TRACE_TIME"
    if (cycle_ms == "") cycle_ms = 100
    cycle = nanoseconds(cycle_ms "")
    if (cycle + 0 <= 0) fail("the cycle must be above 0")
}

{ sub(/\r$/, "") }

# The map: `rung` writes each member on a line of its own, and the name or size of a list before it.
FNR == NR {
    if (/^  "[a-z]+": \[/) list = $1
    else if (/^  \]/) list = ""
    value = $0
    sub(/^ *"[a-z]+": /, "", value)
    sub(/,$/, "", value)
    gsub(/^"|"$/, "", value)
    if (list == "\"slots\":") {
        if ($1 == "\"name\":") slot = value
        if ($1 == "\"type\":") type_of[slot] = value
        if ($1 == "\"offset\":") offset_of[slot] = value
    } else if (list == "\"observed\":") {
        if ($1 == "\"name\":") names[++columns] = value
        if ($1 == "\"slot\":") {
            slots[columns] = value
            slot_named[tolower(names[columns])] = value
        }
    }
    next
}

# The stimuli.
!header_cells {
    header_cells = csv($0)
    if (cells[1] != "time_ms") fail("stimuli start with the column time_ms")
    for (cell = 2; cell <= header_cells; cell++) {
        if (!(tolower(cells[cell]) in slot_named)) fail("the program has no variable `" cells[cell] "`")
        set_by[cell] = slot_named[tolower(cells[cell])]
    }
    next
}
/^[ \t]*$/ { next }
{
    if (csv($0) != header_cells) fail("line " FNR " has another number of cells than the header")
    last = nanoseconds(cells[1])
    for (cell = 2; cell <= header_cells; cell++) {
        if (cells[cell] == "") continue
        type = type_of[set_by[cell]]
        if (!(type in size)) fail("`" set_by[cell] "` is of type " type ", which these tables do not hold")
        rows = rows "    {" last "ll, " offset_of[set_by[cell]] "u, " size[type] "u, " bits(type, cells[cell]) "},\n"
    }
}

function up(number) { return number == int(number) ? number : int(number) + 1 }

END {
    if (failed) exit 1
    if (columns == 0) fail("this is no map of a program")
    print "/* Made by tables.awk. */\n#include \"trace.h\"\n"
    printf "const char trace_names[] = \"time_ms"
    for (column = 1; column <= columns; column++) printf ",%s", name_in_header(names[column])
    print "\";\n\nconst trace_column_t trace_columns[] = {"
    for (column = 1; column <= columns; column++) {
        type = type_of[slots[column]]
        if (!(type in size)) fail("`" names[column] "` is of type " type ", which this trace does not print")
        print "    {" offset_of[slots[column]] "u, " size[type] "u, " kind[type] "},"
    }
    print "};\nconst uint32_t trace_column_count = " columns "u;\n"
    print "const stimulus_t stimuli[] = {\n" rows "    {INT64_MAX, 0u, 0u, 0u},\n};\n"
    # As `rung sim` does it: a second longer than the last stimulus, which is always reached.
    scans = header_cells ? up((last + 1000000000) / cycle) : 100
    if (header_cells && scans < up(last / cycle) + 1) scans = up(last / cycle) + 1
    print "const int64_t scan_cycle = " cycle "ll;"
    printf "const uint32_t scan_count = %du;\n", scans
}
