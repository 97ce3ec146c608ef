//! Functions on real numbers, made of integer operations, so that they need no library and give the same bits everywhere.

use super::Routine;

pub(super) const ROUTINES: &[Routine] = &[
    Routine {
        stem: "settled",
        types: &["f32"],
        needs: &["bits_f32", "real_f32"],
        text: r"
/* The number; of what is no number the one that all engines leave. */
static inline float settled_f32(const float value)
{
    const uint32_t bits = bits_f32(value);
    const uint32_t nan = 0u - (uint32_t)((bits & 0x7FFFFFFFu) > 0x7F800000u);
    return real_f32((bits & ~nan) | (0x7FC00000u & nan));
}
",
    },
    Routine {
        stem: "settled",
        types: &["f64"],
        needs: &["bits_f64", "real_f64", "lt_u64"],
        text: r"
/* The number; of what is no number the one that all engines leave. */
static inline double settled_f64(const double value)
{
    const uint64_t bits = bits_f64(value);
    const uint64_t size = bits & UINT64_C(0x7FFFFFFFFFFFFFFF);
    const uint64_t nan = (uint64_t)0u - (uint64_t)lt_u64(UINT64_C(0x7FF0000000000000), size);
    return real_f64((bits & ~nan) | (UINT64_C(0x7FF8000000000000) & nan));
}
",
    },
    Routine {
        stem: "neg",
        types: &["f32", "f64"],
        needs: &["bits_@N", "real_@N"],
        text: r"
/* The number with the other sign. */
static inline @T neg_@N(const @T value)
{
    return real_@N(bits_@N(value) ^ ((@U)1u << (@W - 1)));
}
",
    },
    Routine {
        stem: "abs",
        types: &["f32", "f64"],
        needs: &["bits_@N", "real_@N"],
        text: r"
/* The number without its sign. */
static inline @T abs_@N(const @T value)
{
    return real_@N(bits_@N(value) & (((@U)1u << (@W - 1)) - 1u));
}
",
    },
    Routine {
        stem: "sqrt",
        types: &["f32"],
        needs: &["bits_f32", "real_f32"],
        text: r"
/* The square root, rounded to nearest, bit by bit. */
static float sqrt_f32(const float value)
{
    const uint32_t bits = bits_f32(value);
    const uint32_t size = bits & 0x7FFFFFFFu;
    const uint32_t normal = (uint32_t)(size >= 0x00800000u);
    uint32_t exponent = (size >> 23) + 1u - normal;
    uint32_t rest = (size & 0x007FFFFFu) | (normal << 23);
    uint32_t sum = 0u;
    uint32_t root = 0u;
    for (uint32_t step = 16u; step > 0u; step >>= 1)
    {
        /* A small number is moved up until it has its leading bit. */
        const uint32_t lacks = (uint32_t)((rest >> (24u - step)) == 0u);
        rest <<= step * lacks;
        exponent -= step * lacks;
    }
    /* From here on an even power of two is taken out, and as many bits of the root made as it has, and one more. */
    exponent += 127u;
    rest <<= exponent & 1u;
    rest <<= 1;
    for (uint32_t bit = 0x01000000u; bit > 0u; bit >>= 1)
    {
        const uint32_t less = rest - (sum + bit);
        const uint32_t fits = (less >> 31) - 1u;
        rest = (less & fits) | (rest & ~fits);
        sum += (2u * bit) & fits;
        root += bit & fits;
        rest <<= 1;
    }
    root = ((root + (root & 1u)) >> 1) + (((exponent >> 1) - 1u) << 23);
    {
        /* Zero and infinity are their own roots; a number below zero has none. */
        const uint32_t itself = 0u - ((uint32_t)(size == 0u) | (uint32_t)(bits == 0x7F800000u));
        const uint32_t none = 0u - ((uint32_t)(size > 0x7F800000u) | (uint32_t)(bits > 0x80000000u));
        root = (root & ~itself) | (bits & itself);
        root = (root & ~none) | (0x7FC00000u & none);
    }
    return real_f32(root);
}
",
    },
    Routine {
        stem: "sqrt",
        types: &["f64"],
        needs: &["bits_f64", "real_f64", "lt_u64"],
        text: r"
/* The square root, rounded to nearest, bit by bit. */
static double sqrt_f64(const double value)
{
    const uint64_t bits = bits_f64(value);
    const uint64_t size = bits & UINT64_C(0x7FFFFFFFFFFFFFFF);
    const uint32_t high = (uint32_t)(size >> 52);
    const uint32_t normal = (uint32_t)(high != 0u);
    uint32_t exponent = high + 1u - normal;
    uint64_t rest = (size & UINT64_C(0x000FFFFFFFFFFFFF)) | ((uint64_t)normal << 52);
    uint64_t sum = 0u;
    uint64_t root = 0u;
    for (uint32_t step = 32u; step > 0u; step >>= 1)
    {
        /* A small number is moved up until it has its leading bit. */
        const uint32_t lacks = (uint32_t)((rest >> (53u - step)) == 0u);
        rest <<= step * lacks;
        exponent -= step * lacks;
    }
    /* From here on an even power of two is taken out, and as many bits of the root made as it has, and one more. */
    exponent += 1023u;
    rest <<= exponent & 1u;
    rest <<= 1;
    for (uint64_t bit = UINT64_C(0x0020000000000000); bit > 0u; bit >>= 1)
    {
        const uint64_t less = rest - (sum + bit);
        const uint64_t fits = (less >> 63) - 1u;
        rest = (less & fits) | (rest & ~fits);
        sum += (2u * bit) & fits;
        root += bit & fits;
        rest <<= 1;
    }
    root = ((root + (root & 1u)) >> 1) + (((uint64_t)(exponent >> 1) - 1u) << 52);
    {
        /* Zero and infinity are their own roots; a number below zero has none. */
        const uint64_t itself = (uint64_t)0u - ((uint64_t)(size == 0u) | (uint64_t)(bits == UINT64_C(0x7FF0000000000000)));
        const uint64_t negative = (bits >> 63) & (uint64_t)(size != 0u);
        const uint64_t nan = (uint64_t)lt_u64(UINT64_C(0x7FF0000000000000), size);
        const uint64_t none = (uint64_t)0u - (negative | nan);
        root = (root & ~itself) | (bits & itself);
        root = (root & ~none) | (UINT64_C(0x7FF8000000000000) & none);
    }
    return real_f64(root);
}
",
    },
    Routine {
        stem: "whole",
        types: &[],
        needs: &[],
        text: r"
/* The fraction, of 53 bits, of a number with this exponent as a whole number, rounded half to even; too large a one as the
   largest. */
static uint64_t whole(const uint64_t fraction, const uint32_t exponent)
{
    const uint32_t is_below = 0u - (uint32_t)(exponent < 1075u);
    const uint32_t is_far = 0u - (uint32_t)(exponent < (1075u - 63u));
    const uint32_t down = ((1075u - exponent) & is_below & ~is_far) | (63u & is_far);
    const uint32_t up = (exponent - 1075u) & ~is_below;
    const uint64_t half = (UINT64_C(1) << down) >> 1;
    const uint64_t rest = fraction & ((UINT64_C(1) << down) - 1u);
    const uint64_t floor = fraction >> down;
    /* Half or more is left, and the number is odd or more than half is left. */
    const uint64_t at_least = 1u - ((rest - half) >> 63);
    const uint64_t more = at_least & ((floor & 1u) | (uint64_t)(rest != half)) & (uint64_t)(is_below & 1u);
    const uint64_t beyond = (uint64_t)0u - (uint64_t)(up > 11u);
    return ((floor + more) << (up & 15u)) | beyond;
}
",
    },
    Routine {
        stem: "held",
        types: &[],
        needs: &["lt_u64"],
        text: r"
/* A magnitude held at the end of the range on its side, with its sign. */
static uint64_t held(const uint64_t size, const uint8_t negative, const uint64_t down, const uint64_t up)
{
    const uint64_t sign = (uint64_t)0u - (uint64_t)negative;
    const uint64_t limit = ((up ^ down) & sign) ^ up;
    const uint64_t within = (uint64_t)0u - (uint64_t)lt_u64(size, limit);
    return ((((size ^ limit) & within) ^ limit) ^ sign) - sign;
}
",
    },
    Routine {
        stem: "integer",
        types: &["f32"],
        needs: &["bits_f32", "whole", "held"],
        text: r"
/* A number as an integer, rounded half to even, from -down to up; 0 for what is no number. */
static uint64_t integer_f32(const float value, const uint64_t down, const uint64_t up)
{
    const uint32_t bits = bits_f32(value);
    const uint32_t size = bits & 0x7FFFFFFFu;
    const uint32_t number = 0u - (uint32_t)(size <= 0x7F800000u);
    const uint32_t exponent = size >> 23;
    const uint32_t fraction = (size & 0x007FFFFFu) | ((uint32_t)(exponent != 0u) << 23);
    /* As those of the same LREAL. */
    const uint64_t magnitude = whole((uint64_t)(fraction & number) << 29, (exponent & number) + 896u);
    return held(magnitude, (uint8_t)(bits >> 31), down, up);
}
",
    },
    Routine {
        stem: "integer",
        types: &["f64"],
        needs: &["bits_f64", "lt_u64", "whole", "held"],
        text: r"
/* A number as an integer, rounded half to even, from -down to up; 0 for what is no number. */
static uint64_t integer_f64(const double value, const uint64_t down, const uint64_t up)
{
    const uint64_t bits = bits_f64(value);
    const uint64_t any = bits & UINT64_C(0x7FFFFFFFFFFFFFFF);
    const uint64_t nan = (uint64_t)0u - (uint64_t)lt_u64(UINT64_C(0x7FF0000000000000), any);
    const uint64_t size = any & ~nan;
    const uint32_t exponent = (uint32_t)(size >> 52);
    const uint64_t fraction = (size & UINT64_C(0x000FFFFFFFFFFFFF)) | ((uint64_t)(exponent != 0u) << 52);
    return held(whole(fraction, exponent), (uint8_t)(bits >> 63), down, up);
}
",
    },
    Routine {
        stem: "unsigned",
        types: &["f32", "f64"],
        needs: &[],
        text: r"
/* A large unsigned number, rounded once: half of it, with the lost bit kept so that rounding sees it, and doubled. */
static inline @T unsigned_@N(const uint64_t value)
{
    const uint64_t top = value >> 63;
    const uint64_t half = (value >> top) | (value & top);
    return (@T)(int64_t)half * (@T)(int32_t)(1 + (int32_t)top);
}
",
    },
];
