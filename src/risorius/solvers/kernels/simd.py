# pyright: basic, reportCallIssue=false, reportOptionalCall=false
# ruff: noqa: PLW0108
"""Vectors of 8 or 16 floats as a Numba type, with arithmetic that maps to vector instructions.

LLVM vectorises loops over constraints poorly: their particles lie scattered. An explicit vector
type keeps formulas readable and the same for numbers and vectors, and reaches the speed of
hand-written C++. Machines with shorter registers split the vectors by themselves.

`LANES` poses lie side by side in `lanes`, in one register. `packed` takes `PACK` constraints at a
time, in two registers of half the width: collecting particles is mostly shuffling, which is faster
in halves, and the two chains of arithmetic hide each other's delays.
"""

import math
import operator

from llvmlite import binding, ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, overload, register_model

__all__ = [
    "LANES",
    "PACK",
    "PACK_PARTS",
    "VectorType",
    "larger",
    "reciprocal",
    "reciprocal_root",
    "signed_angle",
    "splat",
]

LANES = 16
PACK = 16
PACK_PARTS = 2

# atan(t) / t for |t| <= 1 in powers of t^2 to 2e-8 (Abramowitz and Stegun 4.4.49).
_ATAN = (
    -0.3333314528,
    0.1999355085,
    -0.1420889944,
    0.1065626393,
    -0.0752896400,
    0.0429096138,
    -0.0161657367,
    0.0028662257,
)


class VectorType(types.Type):
    """The type of a vector of so many numbers of one float type, in one register or several."""

    def __init__(self, element, width, parts):
        self.element = element
        self.width = width
        self.parts = parts
        super().__init__(f"vector{width}x{element}in{parts}")


@register_model(VectorType)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, manager, vector):
        element = manager.lookup(vector.element).get_value_type()
        part = ir.VectorType(element, vector.width // vector.parts)
        super().__init__(manager, vector, ir.LiteralStructType([part] * vector.parts))


def parts_of(builder, value):
    """Emit the registers of a vector."""
    return [builder.extract_value(value, part) for part in range(len(value.type.elements))]


def joined(builder, parts):
    """Emit the vector made of registers."""
    value = ir.Constant(ir.LiteralStructType([part.type for part in parts]), ir.Undefined)
    for place, part in enumerate(parts):
        value = builder.insert_value(value, part, place)
    return value


def mapped(builder, function, *values):
    """Emit `function` for each register of the vectors."""
    registers = [parts_of(builder, value) for value in values]
    return joined(builder, [function(*parts) for parts in zip(*registers, strict=True)])


def shuffled(builder, first, second, lanes):
    """Emit the vector of the named lanes of two vectors laid end to end."""
    mask = ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), list(lanes))
    return builder.shuffle_vector(first, second, mask)


def _spread(builder, number, vector):
    count = vector.width // vector.parts
    empty = ir.Constant(ir.VectorType(number.type, count), ir.Undefined)
    first = builder.insert_element(empty, number, ir.Constant(ir.IntType(32), 0))
    return joined(builder, [shuffled(builder, first, empty, [0] * count)] * vector.parts)


def _constant(vector, number):
    return ir.Constant(vector, [number] * vector.count)


def _call(builder, name, value):
    """Emit the call of an LLVM function of one register."""
    suffix = "f32" if isinstance(value.type.element, ir.FloatType) else "f64"
    kind = ir.FunctionType(value.type, [value.type])
    full_name = f"llvm.{name}.v{value.type.count}{suffix}"
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, full_name), [value])


def _operands(context, builder, sig, args):
    """Spread the numbers among the operands over all lanes."""
    vector = sig.return_type
    for value, kind in zip(args, sig.args, strict=True):
        if isinstance(kind, VectorType):
            yield value
        else:
            number = context.cast(builder, value, kind, vector.element)
            yield _spread(builder, number, vector)


def _add_operator(operations, instruction):
    def emit(context, builder, sig, args):
        operands = _operands(context, builder, sig, args)
        return mapped(builder, getattr(builder, instruction), *operands)

    def register(operation):
        @infer_global(operation)
        class _Template(AbstractTemplate):
            def generic(self, args, kws):
                vectors = [kind for kind in args if isinstance(kind, VectorType)]
                fitting = all(isinstance(kind, (VectorType, types.Float)) for kind in args)
                return signature(vectors[0], *args) if vectors and fitting else None

        for kinds in ((VectorType, VectorType), (VectorType, types.Float)):
            lower_builtin(operation, *kinds)(emit)
        lower_builtin(operation, types.Float, VectorType)(emit)

    for operation in operations:
        register(operation)


_add_operator((operator.add, operator.iadd), "fadd")
_add_operator((operator.sub, operator.isub), "fsub")
_add_operator((operator.mul, operator.imul), "fmul")
_add_operator((operator.truediv, operator.itruediv), "fdiv")


@infer_global(operator.neg)
@infer_global(math.sqrt)
class _Unary(AbstractTemplate):
    def generic(self, args, kws):
        return signature(args[0], args[0]) if isinstance(args[0], VectorType) else None


@lower_builtin(operator.neg, VectorType)
def _neg(context, builder, sig, args):
    return mapped(builder, lambda part: builder.fsub(_constant(part.type, -0.0), part), args[0])


@lower_builtin(math.sqrt, VectorType)
def _sqrt(context, builder, sig, args):
    return mapped(builder, lambda part: _call(builder, "sqrt", part), args[0])


def _has_estimates(register):
    """Tell whether the processor estimates reciprocals of such registers (AVX-512)."""
    features = binding.get_host_cpu_features()
    known = features.get("avx512f") and features.get("avx512vl")
    return bool(known) and isinstance(register.element, ir.FloatType) and register.count in (8, 16)


def _estimate(builder, name, value):
    """Emit the 14-bit estimate of a reciprocal or of a reciprocal root."""
    width = value.type.count
    mask = ir.Constant(ir.IntType(width), 2**width - 1)
    kind = ir.FunctionType(value.type, [value.type, value.type, mask.type])
    function = cgutils.get_or_insert_function(
        builder.module, kind, f"llvm.x86.avx512.{name}14.ps.{32 * width}"
    )
    return builder.call(function, [value, _constant(value.type, 0.0), mask])


@intrinsic
def _vector_reciprocal(typing, vector):
    """Return 1 / x; where there are estimates to 2 units in the last place, by one Newton step."""

    def one(builder, value):
        if not _has_estimates(value.type):
            return builder.fdiv(_constant(value.type, 1.0), value)
        guess = _estimate(builder, "rcp", value)
        rest = builder.fsub(_constant(value.type, 2.0), builder.fmul(value, guess))
        return builder.fmul(guess, rest)

    def emit(context, builder, sig, args):
        return mapped(builder, lambda part: one(builder, part), args[0])

    return vector(vector), emit


@intrinsic
def _vector_reciprocal_root(typing, vector):
    """Return 1 / sqrt(x), as `_vector_reciprocal`."""

    def one(builder, value):
        if not _has_estimates(value.type):
            return builder.fdiv(_constant(value.type, 1.0), _call(builder, "sqrt", value))
        guess = _estimate(builder, "rsqrt", value)
        half = builder.fmul(_constant(value.type, 0.5), value)
        square = builder.fmul(builder.fmul(half, guess), guess)
        return builder.fmul(guess, builder.fsub(_constant(value.type, 1.5), square))

    def emit(context, builder, sig, args):
        return mapped(builder, lambda part: one(builder, part), args[0])

    return vector(vector), emit


@intrinsic
def splat(typing, array, number):
    """Return the `LANES` wide vector of the array's type that holds `number` in every lane."""
    vector = VectorType(array.dtype, LANES, 1)

    def emit(context, builder, sig, args):
        return _spread(builder, context.cast(builder, args[1], number, vector.element), vector)

    return vector(array, number), emit


@intrinsic
def _select(typing, test, first, second):
    """Return `first` where `test` >= 0, else `second`."""

    def emit(context, builder, sig, args):
        def one(test, first, second):
            zero = _constant(test.type, 0.0)
            return builder.select(builder.fcmp_ordered(">=", test, zero), first, second)

        return mapped(builder, one, *args)

    return first(test, first, second), emit


@intrinsic
def _magnitude(typing, vector):
    """Return the absolute value."""

    def emit(context, builder, sig, args):
        return mapped(builder, lambda part: _call(builder, "fabs", part), args[0])

    return vector(vector), emit


def larger(first, second):
    """Return the larger of two numbers, or of two vectors lane by lane."""
    return max(first, second)


@overload(larger)
def _larger(first, second):
    if isinstance(first, VectorType):
        return lambda first, second: _select(first - second, first, second)
    return lambda first, second: first if first >= second else second


def reciprocal(value):
    """Return 1 / x of a number or a vector; x must not be 0."""
    return 1.0 / value


@overload(reciprocal)
def _reciprocal(value):
    if isinstance(value, VectorType):
        return lambda value: _vector_reciprocal(value)
    return lambda value: 1.0 / value


def reciprocal_root(value):
    """Return 1 / sqrt(x) of a number or a vector; x must be above 0."""
    return 1.0 / math.sqrt(value)


@overload(reciprocal_root)
def _reciprocal_root(value):
    if isinstance(value, VectorType):
        return lambda value: _vector_reciprocal_root(value)
    return lambda value: 1.0 / math.sqrt(value)


def signed_angle(sine, cosine):
    """Return the angle in (-pi, pi] whose sine and cosine are given, of length 1 [rad].

    For vectors atan of the half angle by a polynomial, to 4e-8.
    """
    return math.atan2(sine, cosine)


@overload(signed_angle)
def _signed_angle(sine, cosine):
    if not isinstance(sine, VectorType):
        return lambda sine, cosine: math.atan2(sine, cosine)
    a, b, c, d, e, f, g, h = _ATAN

    def by_half_angle(sine, cosine):
        t = sine * _vector_reciprocal(_magnitude(cosine) + 1.0)
        u = t * t
        v = u * u
        # In powers of t^4: less deep than in t^2, and small angles stay clear of denormal numbers.
        high = v * (v * h + (u * g + f)) + (u * e + d)
        sharp = (t + t) * (v * (v * high + (u * c + b)) + (u * a + 1.0))
        half_turn = _select(sine, sine * 0.0 + math.pi, sine * 0.0 - math.pi)
        return _select(cosine, sharp, half_turn - sharp)

    return by_half_angle
