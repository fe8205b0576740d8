// A number of the field of 2^61 - 2373 elements, in which a relation holds exactly or not at all.
// Signs are Legendre symbols; functions are asked of Python, which answers by its random tables.
#ifndef FIELD_HPP
#define FIELD_HPP

#include <cstdint>
#include <cstdlib>
#include <cstring>

extern "C" {
typedef uint64_t (*field_function)(const char *name, uint64_t x, uint64_t y);
extern field_function field_lookup;
}

struct Field {
    static constexpr uint64_t P = (UINT64_C(1) << 61) - 2373;
    uint64_t v = 0;
    bool huge = false; // a bound that every number keeps

    Field() = default;
    Field(int64_t x) : v(x < 0 ? P - (uint64_t)-x : (uint64_t)x) {}
    Field(int x) : Field((int64_t)x) {}
    Field(uint32_t x) : v(x) {}
    Field(float x) : Field((double)x) {}
    Field(double x) : v((uint64_t)(x > -1e15 && x < 1e15 ? x : 0)), huge(!(x > -1e15 && x < 1e15)) {}
    static Field of(uint64_t x) { Field f; f.v = x % P; return f; }
    explicit operator uint32_t() const { return (uint32_t)v; }

    static uint64_t mul(uint64_t a, uint64_t b) { return (uint64_t)((unsigned __int128)a * b % P); }
    static uint64_t pow(uint64_t a, uint64_t n)
    {
        uint64_t r = 1;
        for (; n; n >>= 1, a = mul(a, a)) { if (n & 1) r = mul(r, a); }
        return r;
    }
    int sign() const { uint64_t s = pow(v, (P - 1) / 2); return s == P - 1 ? -1 : (int)s; }

    // A decimal literal, exactly.
    static Field decimal(const char *text)
    {
        Field f(0);
        long shift = 0;
        bool point = false;
        for (; *text && *text != 'e'; ++text) {
            if (*text == '.') { point = true; continue; }
            if (*text < '0' || *text > '9') continue;
            f.v = (mul(f.v, 10) + (uint64_t)(*text - '0')) % P;
            shift -= point;
        }
        if (*text == 'e') shift += atol(text + 1);
        uint64_t ten = shift < 0 ? pow(10, P - 2) : 10;
        f.v = mul(f.v, pow(ten, (uint64_t)labs(shift)));
        return f;
    }
};

inline Field operator+(Field a, Field b) { return Field::of((a.v + b.v) % Field::P); }
inline Field operator-(Field a) { Field f = Field::of(a.v ? Field::P - a.v : 0); f.huge = a.huge; return f; }
inline Field operator-(Field a, Field b) { return a + -b; }
inline Field operator*(Field a, Field b) { return Field::of(Field::mul(a.v, b.v)); }
inline Field operator/(Field a, Field b) { return Field::of(Field::mul(a.v, Field::pow(b.v, Field::P - 2))); }
inline Field &operator+=(Field &a, Field b) { return a = a + b; }
inline Field &operator-=(Field &a, Field b) { return a = a - b; }
inline Field &operator*=(Field &a, Field b) { return a = a * b; }
inline bool operator<(Field a, Field b) { return !a.huge && !b.huge && (b - a).sign() == 1; }
inline bool operator<=(Field a, Field b) { return a.huge || b.huge || (b - a).sign() != -1; }
inline bool operator>(Field a, Field b) { return b < a; }
inline bool operator>=(Field a, Field b) { return b <= a; }

#define FIELD_FUNCTION(name) \
    inline Field name(Field x) { return Field::of(field_lookup(#name, x.v, 0)); }
FIELD_FUNCTION(fabs) FIELD_FUNCTION(sqrt) FIELD_FUNCTION(cbrt) FIELD_FUNCTION(exp)
FIELD_FUNCTION(log) FIELD_FUNCTION(sin) FIELD_FUNCTION(cos) FIELD_FUNCTION(tan)
FIELD_FUNCTION(asin) FIELD_FUNCTION(acos) FIELD_FUNCTION(atan) FIELD_FUNCTION(sinh)
FIELD_FUNCTION(cosh) FIELD_FUNCTION(tanh) FIELD_FUNCTION(asinh) FIELD_FUNCTION(acosh)
FIELD_FUNCTION(atanh)

#endif
