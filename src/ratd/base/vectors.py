"""Four or eight numbers that are moved and computed as one: a vector register of a processor.

A row of a monomer holds its position, velocity and spin four numbers to a vector (`ratd.engine.layout`); blocks of six
are padded to eight (`ratd.engine.block_factor`). The compiler does not find that by itself in loops with as many steps
as those of the drives, so they say it.
"""

import math

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic, models, register_model

from ratd.base.jit import jit

_INDEX = ir.IntType(32)


class Vector(types.Type):
    """The type of such a vector in compiled code.

    Parameters
    ----------
    size : int
    """

    def __init__(self, size):
        self.size = size
        self.ir = ir.VectorType(ir.DoubleType(), size)
        super().__init__(name=f"Vector{size}")


@register_model(Vector)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, fe_type.ir)


VECTOR4, VECTOR8 = Vector(4), Vector(8)


def _pointer(vector, context, builder, kind, array, index):
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), vector.ir.as_pointer())


def _build(vector, builder, numbers):
    found = ir.Constant(vector.ir, ir.Undefined)
    for lane, number in enumerate(numbers):
        found = builder.insert_element(found, number, ir.Constant(_INDEX, lane))
    return found


def _spread(vector, builder, number):
    first = builder.insert_element(ir.Constant(vector.ir, ir.Undefined), number, ir.Constant(_INDEX, 0))
    return builder.shuffle_vector(first, first, _lanes([0] * vector.size))


def _lanes(numbers):
    return ir.Constant(ir.VectorType(_INDEX, len(numbers)), list(numbers))


def _pick(builder, vector, lane):
    return builder.extract_element(vector, ir.Constant(_INDEX, lane))


def _loader(vector):
    """``load(array, index)``: the vector that begins at ``array[index]``; `index` is a uint64."""

    @intrinsic
    def load(typingctx, array, index):
        def generate(context, builder, signature, arguments):
            return builder.load(_pointer(vector, context, builder, signature.args[0], *arguments), align=8)

        return vector(array, types.uint64), generate

    return load


def _storer(vector):
    """``store(array, index, v)``: store a vector at ``array[index]`` and the numbers after it."""

    @intrinsic
    def store(typingctx, array, index, v):
        def generate(context, builder, signature, arguments):
            builder.store(arguments[2], _pointer(vector, context, builder, signature.args[0], *arguments[:2]), align=8)
            return context.get_dummy_value()

        return types.void(array, types.uint64, vector), generate

    return store


def _operation(vector, name):
    """An operation of two vectors, lane by lane, by its name in `llvmlite.ir.IRBuilder`."""

    @intrinsic
    def operate(typingctx, a, b):
        def generate(context, builder, signature, arguments):
            return getattr(builder, name)(*arguments, flags=("contract",))

        return vector(vector, vector), generate

    return operate


load4, store4 = _loader(VECTOR4), _storer(VECTOR4)
load8, store8 = _loader(VECTOR8), _storer(VECTOR8)
add4, multiply4 = (_operation(VECTOR4, name) for name in ("fadd", "fmul"))
add8, subtract8, multiply8 = (_operation(VECTOR8, name) for name in ("fadd", "fsub", "fmul"))


@intrinsic
def vector4(typingctx, a, b, c, d):
    """A vector of four numbers."""

    def generate(context, builder, signature, arguments):
        return _build(VECTOR4, builder, arguments)

    return VECTOR4(*[types.float64] * 4), generate


@intrinsic
def scale4(typingctx, factor, vector):
    """A number times a vector."""

    def generate(context, builder, signature, arguments):
        return builder.fmul(_spread(VECTOR4, builder, arguments[0]), arguments[1], flags=("contract",))

    return VECTOR4(types.float64, VECTOR4), generate


@intrinsic
def swap4(typingctx, vector):
    """(y, x, 0, 0) of (x, y, z, .)."""

    def generate(context, builder, signature, arguments):
        zero = ir.Constant(VECTOR4.ir, [0.0] * 4)
        return builder.shuffle_vector(arguments[0], zero, _lanes([1, 0, 4, 4]))

    return VECTOR4(VECTOR4), generate


@intrinsic
def next4(typingctx, vector):
    """(y, z, x, .) of (x, y, z, .)."""

    def generate(context, builder, signature, arguments):
        (vector,) = arguments
        return builder.shuffle_vector(vector, vector, _lanes([1, 2, 0, 3]))

    return VECTOR4(VECTOR4), generate


@intrinsic
def square4(typingctx, vector):
    """x^2 + y^2 + z^2 of (x, y, z, .)."""

    def generate(context, builder, signature, arguments):
        (vector,) = arguments
        product = builder.fmul(vector, vector)
        x, y, z = (_pick(builder, product, lane) for lane in range(3))
        return builder.fadd(builder.fadd(x, y), z)

    return types.float64(VECTOR4), generate


@intrinsic
def greater4(typingctx, a, b):
    """The greater of two vectors, lane by lane; that of `b` where a number is NaN."""

    def generate(context, builder, signature, arguments):
        return builder.select(builder.fcmp_ordered(">", *arguments), *arguments)

    return VECTOR4(VECTOR4, VECTOR4), generate


@intrinsic
def numbers4(typingctx, vector):
    """The four numbers of a vector, a tuple."""

    def generate(context, builder, signature, arguments):
        lanes = [_pick(builder, arguments[0], lane) for lane in range(4)]
        return context.make_tuple(builder, signature.return_type, lanes)

    return types.UniTuple(types.float64, 4)(VECTOR4), generate


@jit
def root_of_sum(squares):
    """sqrt(x + y + z) of (x, y, z, .).

    Of the greatest squares of three components that is a bound on the length of every vector, and at most sqrt(3) times
    the greatest one; the sum has to be made only once.
    """
    x, y, z, _ = numbers4(squares)
    return math.sqrt(x + y + z)


@intrinsic
def spread8(typingctx, number):
    """A vector of eight times the same number."""

    def generate(context, builder, signature, arguments):
        return _spread(VECTOR8, builder, arguments[0])

    return VECTOR8(types.float64), generate


@intrinsic
def sum8(typingctx, vector):
    """The sum of the eight numbers, by halves."""

    def generate(context, builder, signature, arguments):
        (vector,) = arguments
        size = 8
        while size > 1:
            size //= 2
            low, high = _lanes(range(size)), _lanes(range(size, 2 * size))
            vector = builder.fadd(
                builder.shuffle_vector(vector, vector, low), builder.shuffle_vector(vector, vector, high)
            )
        return _pick(builder, vector, 0)

    return types.float64(VECTOR8), generate
