//! Functions on integers and arrays, and selections of every type.

use super::Routine;

const INTEGERS: &[&str] = &["u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64"];
const ALL: &[&str] = &["u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f32", "f64"];

pub(super) const ROUTINES: &[Routine] = &[
    Routine {
        stem: "bits",
        types: &["f32", "f64"],
        needs: &[],
        text: r"
/* The bits of a real number. */
static inline @U bits_@N(const @T value)
{
    union { @T real; @U bits; } view;
    view.real = value;
    return view.bits;
}
",
    },
    Routine {
        stem: "real",
        types: &["f32", "f64"],
        needs: &[],
        text: r"
/* The real number of bits. */
static inline @T real_@N(const @U bits)
{
    union { @T real; @U bits; } view;
    view.bits = bits;
    return view.real;
}
",
    },
    Routine {
        stem: "lt",
        types: &["u64"],
        needs: &[],
        text: r"
/* Whether a is less than b; on machines of 32 bits without the branch that compilers make of it. */
static inline uint8_t lt_u64(const uint64_t a, const uint64_t b)
{
#if UINTPTR_MAX > 0xFFFFFFFFu
    return (uint8_t)(a < b);
#else
    const uint32_t a_high = (uint32_t)(a >> 32);
    const uint32_t b_high = (uint32_t)(b >> 32);
    const uint32_t low = (uint32_t)((uint32_t)a < (uint32_t)b);
    return (uint8_t)((uint32_t)(a_high < b_high) | ((uint32_t)(a_high == b_high) & low));
#endif
}
",
    },
    Routine {
        stem: "lt",
        types: &["i64"],
        needs: &[],
        text: r"
/* Whether a is less than b; on machines of 32 bits without the branch that compilers make of it. */
static inline uint8_t lt_i64(const int64_t a, const int64_t b)
{
#if UINTPTR_MAX > 0xFFFFFFFFu
    return (uint8_t)(a < b);
#else
    const int32_t a_high = (int32_t)(uint32_t)((uint64_t)a >> 32);
    const int32_t b_high = (int32_t)(uint32_t)((uint64_t)b >> 32);
    const uint32_t low = (uint32_t)((uint32_t)(uint64_t)a < (uint32_t)(uint64_t)b);
    return (uint8_t)((uint32_t)(a_high < b_high) | ((uint32_t)(a_high == b_high) & low));
#endif
}
",
    },
    Routine {
        stem: "select",
        types: INTEGERS,
        needs: &[],
        text: r"
/* a where c is 1, b where it is 0. */
static inline @T select_@N(const uint8_t c, const @T a, const @T b)
{
    const @U mask = (@U)0u - (@U)c;
    return (@T)((((@U)a ^ (@U)b) & mask) ^ (@U)b);
}
",
    },
    Routine {
        stem: "select",
        types: &["f32", "f64"],
        needs: &["bits_@N", "real_@N"],
        text: r"
/* a where c is 1, b where it is 0. */
static inline @T select_@N(const uint8_t c, const @T a, const @T b)
{
    const @U mask = (@U)0u - (@U)c;
    return real_@N(((bits_@N(a) ^ bits_@N(b)) & mask) ^ bits_@N(b));
}
",
    },
    Routine {
        stem: "less",
        types: &["u8", "i8", "u16", "i16"],
        needs: &[],
        text: r"
/* Whether a is less than b, from the sign of the difference: of a comparison and a choice compilers make a branch. */
static inline uint8_t less_@N(const @T a, const @T b)
{
    return (uint8_t)(((uint32_t)a - (uint32_t)b) >> 31);
}
",
    },
    Routine {
        stem: "less",
        types: &["u32", "u64"],
        needs: &[],
        text: r"
/* Whether a is less than b, from the borrow of the difference: of a comparison and a choice compilers make a branch. */
static inline uint8_t less_@N(const @T a, const @T b)
{
    return (uint8_t)(((~a & b) | ((~a | b) & (a - b))) >> (@W - 1));
}
",
    },
    Routine {
        stem: "less",
        types: &["i32", "i64"],
        needs: &[],
        text: r"
/* Whether a is less than b, from the sign of the difference: of a comparison and a choice compilers make a branch. */
static inline uint8_t less_@N(const @T a, const @T b)
{
    const @U x = (@U)a;
    const @U y = (@U)b;
    return (uint8_t)(((x & ~y) | ((x | ~y) & (x - y))) >> (@W - 1));
}
",
    },
    Routine {
        stem: "min",
        types: INTEGERS,
        needs: &["less_@N", "select_@N"],
        text: r"
/* The lesser. */
static inline @T min_@N(const @T a, const @T b)
{
    return select_@N(less_@N(a, b), a, b);
}
",
    },
    Routine {
        stem: "max",
        types: INTEGERS,
        needs: &["less_@N", "select_@N"],
        text: r"
/* The greater. */
static inline @T max_@N(const @T a, const @T b)
{
    return select_@N(less_@N(a, b), b, a);
}
",
    },
    Routine {
        stem: "abs",
        types: &["i32", "i64"],
        needs: &[],
        text: r"
/* The magnitude. */
static inline @U abs_@N(const @T a)
{
    const @U sign = (@U)0u - ((@U)a >> (@W - 1));
    return ((@U)a ^ sign) - sign;
}
",
    },
    Routine {
        stem: "div",
        types: &["u32", "u64"],
        needs: &[],
        text: r"
/* The quotient; 0 where b is 0. */
static @T div_@N(const @T a, const @T b)
{
    const @T zero = (@T)(b == 0u);
    return (a / (b + zero)) & (zero - 1u);
}
",
    },
    Routine {
        stem: "div",
        types: &["i32", "i64"],
        needs: &[],
        text: r"
/* The quotient, cut towards zero; 0 where b is 0. The least number by -1 is itself: divided by 1 instead. */
static @T div_@N(const @T a, const @T b)
{
    const @T zero = (@T)(b == 0);
    const @T beyond = (@T)((uint8_t)(a == INT@W_MIN) & (uint8_t)(b == -1));
    const @T quotient = a / (b + zero + (2 * beyond));
    return (@T)((@U)quotient & ((@U)zero - 1u));
}
",
    },
    Routine {
        stem: "rem",
        types: &["u32", "u64"],
        needs: &[],
        text: r"
/* What the quotient leaves; 0 where b is 0. */
static @T rem_@N(const @T a, const @T b)
{
    const @T zero = (@T)(b == 0u);
    return a % (b + zero);
}
",
    },
    Routine {
        stem: "rem",
        types: &["i32", "i64"],
        needs: &[],
        text: r"
/* What the quotient leaves, with the sign of a; 0 where b is 0. By -1 it is computed as by 1 where it would not fit. */
static @T rem_@N(const @T a, const @T b)
{
    const @T zero = (@T)(b == 0);
    const @T beyond = (@T)((uint8_t)(a == INT@W_MIN) & (uint8_t)(b == -1));
    return a % (b + zero + (2 * beyond));
}
",
    },
    Routine {
        stem: "shl",
        types: &["u32", "u64"],
        needs: &[],
        text: r"
/* Bits moved up by n; 0 where n is @W or more. */
static inline @T shl_@N(const @T a, const uint32_t n)
{
    const @T within = (@T)0u - (@T)(n < @Wu);
    return (a << (n & (@Wu - 1u))) & within;
}
",
    },
    Routine {
        stem: "shr",
        types: &["u32", "u64"],
        needs: &[],
        text: r"
/* Bits moved down by n; 0 where n is @W or more. */
static inline @T shr_@N(const @T a, const uint32_t n)
{
    const @T within = (@T)0u - (@T)(n < @Wu);
    return (a >> (n & (@Wu - 1u))) & within;
}
",
    },
    Routine {
        stem: "rol",
        types: &["u8", "u16", "u32", "u64"],
        needs: &[],
        text: r"
/* Bits moved up by n and around the end. */
static inline @T rol_@N(const @T a, const uint32_t n)
{
    const uint32_t up = n & (@Wu - 1u);
    const uint32_t down = (0u - n) & (@Wu - 1u);
    return (@T)(((@U)a << up) | ((@U)a >> down));
}
",
    },
    Routine {
        stem: "inside",
        types: &[],
        needs: &[],
        text: r"
/* Whether an array of so many elements has one with this index. */
static inline uint8_t inside(const int64_t index, const uint32_t count)
{
    const uint32_t high = (uint32_t)((uint64_t)index >> 32);
    return (uint8_t)((uint32_t)(high == 0u) & (uint32_t)((uint32_t)(uint64_t)index < count));
}
",
    },
    Routine {
        stem: "at",
        types: ALL,
        needs: &["inside", "select_@N"],
        text: r"
/* The element with this index; zero where there is none. */
static inline @T at_@N(const @T *const array, const uint32_t count, const int64_t index)
{
    const uint8_t there = inside(index, count);
    const uint32_t place = (uint32_t)(uint64_t)index & (0u - (uint32_t)there);
    return select_@N(there, array[place], @0);
}
",
    },
    Routine {
        stem: "put",
        types: ALL,
        needs: &["inside", "select_@N"],
        text: r"
/* Sets the element with this index; where there is none, the first is set to what it is. */
static inline void put_@N(@T *const array, const uint32_t count, const int64_t index, const @T value)
{
    const uint8_t there = inside(index, count);
    const uint32_t place = (uint32_t)(uint64_t)index & (0u - (uint32_t)there);
    array[place] = select_@N(there, value, array[place]);
}
",
    },
    Routine {
        stem: "copy",
        types: ALL,
        needs: &["select_@N"],
        text: r"
/* Copies all elements where c is 1; else each is set to what it is. */
static void copy_@N(@T *const to, const @T *const from, const uint32_t count, const uint8_t c)
{
    for (uint32_t place = 0u; place < count; place++)
    {
        to[place] = select_@N(c, from[place], to[place]);
    }
}
",
    },
    Routine {
        stem: "move",
        types: ALL,
        needs: &[],
        text: r"
/* Copies all elements. */
static void move_@N(@T *const to, const @T *const from, const uint32_t count)
{
    for (uint32_t place = 0u; place < count; place++)
    {
        to[place] = from[place];
    }
}
",
    },
    Routine {
        stem: "turn",
        types: &[],
        needs: &[],
        text: r"
/* The first multiple of an interval after now, or the end of time. */
static int64_t turn(const int64_t interval, const int64_t now)
{
    const int64_t passed = now % interval;
    const int64_t since = passed + ((passed < 0) ? interval : 0);
    const int64_t left = interval - since;
    return (now > (INT64_MAX - left)) ? INT64_MAX : (now + left);
}
",
    },
    Routine {
        stem: "normalise",
        types: &[],
        needs: &[],
        text: r"
/* Makes BOOLs 0 or 1. */
static void normalise(uint8_t *const bytes, const uint32_t from, const uint32_t to)
{
    for (uint32_t place = from; place < to; place++)
    {
        bytes[place] = (uint8_t)(bytes[place] != 0u);
    }
}
",
    },
];
