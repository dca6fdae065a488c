# pyright: basic, reportCallIssue=false
# ruff: noqa: PLR0913, PLR0917
"""Move vectors between arrays and registers."""

import platform

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from risorius.solvers.kernels.simd import (
    LANES,
    PACK,
    PACK_PARTS,
    VectorType,
    joined,
    parts_of,
    shuffled,
)

__all__ = ["gather", "lane_sum", "load", "load_pack", "load_row", "prefetch", "scatter", "store"]

_FIELDS = 4


_WIDTH = PACK // PACK_PARTS


def _pointer(context, builder, kind, array, index, target):
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), ir.PointerType(target))


def _further(builder, index, entries):
    return builder.add(index, ir.Constant(index.type, entries))


def _alignment(kind):
    return kind.dtype.bitwidth // 8


def _loading(array, start, width, parts):
    vector = VectorType(array.dtype, width, parts)

    def emit(context, builder, sig, args):
        registers = []
        for part, target in enumerate(context.get_value_type(vector).elements):
            first = _further(builder, args[1], part * target.count)
            value = builder.load(_pointer(context, builder, array, args[0], first, target))
            value.align = _alignment(array)
            registers.append(value)
        return joined(builder, registers)

    return vector(array, start), emit


@intrinsic
def load(typing, array, start):
    """Return the `LANES` entries of a flat array from `start` on."""
    return _loading(array, start, LANES, 1)


@intrinsic
def load_pack(typing, array, start):
    """Return the `PACK` entries of a flat array from `start` on."""
    return _loading(array, start, PACK, PACK_PARTS)


@intrinsic
def load_row(typing, array, start):
    """Return the four entries of a flat array from `start` on."""
    return _loading(array, start, _FIELDS, 1)


@intrinsic
def store(typing, array, start, vector):
    """Write a vector to the entries of a flat array from `start` on."""

    def emit(context, builder, sig, args):
        for part, value in enumerate(parts_of(builder, args[2])):
            first = _further(builder, args[1], part * value.type.count)
            place = _pointer(context, builder, array, args[0], first, value.type)
            builder.store(value, place).align = _alignment(array)
        return context.get_dummy_value()

    return types.void(array, start, vector), emit


@intrinsic
def prefetch(typing, array, start):
    """Ask for the cache line at entry `start` of a flat array; results do not depend on it."""

    def emit(context, builder, sig, args):
        byte = ir.PointerType(ir.IntType(8))
        data = context.make_array(array)(context, builder, args[0]).data
        place = builder.bitcast(builder.gep(data, [args[1]]), byte)
        word = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte, word, word, word])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        builder.call(function, [place, *(ir.Constant(word, n) for n in (0, 3, 1))])
        return context.get_dummy_value()

    return types.void(array, start), emit


@intrinsic
def lane_sum(typing, vector):
    """Return the sum over the lanes, in halves: a fixed order."""

    def emit(context, builder, sig, args):
        registers = parts_of(builder, args[0])
        value, count = registers[0], vector.width // vector.parts
        for register in registers[1:]:
            value = builder.fadd(value, register)
        while count > 1:
            count //= 2
            low = shuffled(builder, value, value, range(count))
            high = shuffled(builder, value, value, range(count, 2 * count))
            value = builder.fadd(low, high)
        return builder.extract_element(value, ir.Constant(ir.IntType(32), 0))

    return vector.element(vector), emit


# Transposition of _WIDTH rows (x, y, z, w), four at a time: register q holds rows q, q + 4, ...
def _pairs(first, second):
    return [
        lane
        for group in range(_WIDTH // _FIELDS)
        for lane in (
            _FIELDS * group + first,
            _WIDTH + _FIELDS * group + first,
            _FIELDS * group + second,
            _WIDTH + _FIELDS * group + second,
        )
    ]


def _halves(first):
    return [
        lane
        for group in range(_WIDTH // _FIELDS)
        for start in (0, _WIDTH)
        for lane in (start + _FIELDS * group + first, start + _FIELDS * group + first + 1)
    ]


def _transposed(builder, rows):
    low = [shuffled(builder, rows[q], rows[q + 1], _pairs(0, 1)) for q in (0, 2)]
    high = [shuffled(builder, rows[q], rows[q + 1], _pairs(2, 3)) for q in (0, 2)]
    return [shuffled(builder, *half, _halves(first)) for half in (low, high) for first in (0, 2)]


def _end_to_end(builder, pieces):
    while len(pieces) > 1:
        pieces = [
            shuffled(builder, one, two, range(2 * one.type.count))
            for one, two in zip(pieces[::2], pieces[1::2], strict=True)
        ]
    return pieces[0]


def _kept_whole(builder, register):
    """Keep LLVM from doing the last shuffles anew for each half that is stored."""
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return register
    kind = ir.FunctionType(register.type, [register.type])
    return builder.asm(kind, "", "=v,0", [register], False)


def _row(context, builder, kinds, args, lane, row):
    """Return the address of the particle row that lane `lane` of a group names."""
    particles, indices, start = args[:3]
    data = context.make_array(kinds[1])(context, builder, indices).data
    index = builder.load(builder.gep(data, [_further(builder, start, lane)]))
    if index.type.width < 64:
        index = builder.zext(index, ir.IntType(64))
    return _pointer(context, builder, kinds[0], particles, index, row)


def _rows_of(part, q):
    """Return the lanes whose rows lie in register q of a part, in order."""
    return range(part * _WIDTH + q, (part + 1) * _WIDTH, _FIELDS)


@intrinsic
def gather(typing, particles, indices, start):
    """Return x, y, z, w of the `PACK` particles that `indices` names from `start` on.

    `particles` is flat, four numbers each; `indices`, unsigned, are the places of their x.
    """
    vector = VectorType(particles.dtype, PACK, PACK_PARTS)
    result = types.UniTuple(vector, _FIELDS)

    def emit(context, builder, sig, args):
        row = ir.VectorType(context.get_value_type(particles.dtype), _FIELDS)
        fields = []
        for part in range(PACK_PARTS):
            registers = []
            for q in range(_FIELDS):
                pieces = []
                for lane in _rows_of(part, q):
                    value = builder.load(_row(context, builder, sig.args, args, lane, row))
                    value.align = _alignment(particles)
                    pieces.append(value)
                registers.append(_end_to_end(builder, pieces))
            fields.append(_transposed(builder, registers))
        vectors = [joined(builder, parts) for parts in zip(*fields, strict=True)]
        return context.make_tuple(builder, result, vectors)

    return result(particles, indices, start), emit


@intrinsic
def scatter(typing, particles, indices, start, x, y, z, w):
    """Write x, y, z, w to the `PACK` particles that `indices` names from `start` on."""

    def emit(context, builder, sig, args):
        row = ir.VectorType(context.get_value_type(particles.dtype), _FIELDS)
        fields = [parts_of(builder, field) for field in args[3:7]]
        for part in range(PACK_PARTS):
            # The same transposition read the other way: field q of lane l is row l, entry q.
            registers = _transposed(builder, [field[part] for field in fields])
            registers = [_kept_whole(builder, register) for register in registers]
            for q in range(_FIELDS):
                for piece, lane in enumerate(_rows_of(part, q)):
                    entries = range(_FIELDS * piece, _FIELDS * piece + _FIELDS)
                    value = shuffled(builder, registers[q], registers[q], entries)
                    place = _row(context, builder, sig.args, args, lane, row)
                    builder.store(value, place).align = _alignment(particles)
        return context.get_dummy_value()

    return types.void(particles, indices, start, x, y, z, w), emit
