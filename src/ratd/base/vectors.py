"""Four numbers that are moved and computed as one: a vector register of a processor.

A row of a monomer holds its position, velocity and spin four numbers to a vector (`ratd.engine.layout`). The compiler
does not find that by itself in loops with as many steps as those of the drives, so they say it.
"""

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic, models, register_model

_DOUBLE = ir.DoubleType()
_FOUR = ir.VectorType(_DOUBLE, 4)
_INDEX = ir.IntType(32)


class Vector4(types.Type):
    """The type of such a vector in compiled code."""

    def __init__(self):
        super().__init__(name="Vector4")


VECTOR4 = Vector4()


@register_model(Vector4)
class _Vector4Model(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, _FOUR)


def _pointer(context, builder, kind, array, index):
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), _FOUR.as_pointer())


def _build(builder, numbers):
    vector = ir.Constant(_FOUR, ir.Undefined)
    for lane, number in enumerate(numbers):
        vector = builder.insert_element(vector, number, ir.Constant(_INDEX, lane))
    return vector


def _spread(builder, number):
    vector = builder.insert_element(ir.Constant(_FOUR, ir.Undefined), number, ir.Constant(_INDEX, 0))
    return builder.shuffle_vector(vector, vector, ir.Constant(ir.VectorType(_INDEX, 4), [0] * 4))


def _pick(builder, vector, lane):
    return builder.extract_element(vector, ir.Constant(_INDEX, lane))


@intrinsic
def load4(typingctx, array, index):
    """The vector that begins at ``array[index]``; `index` is a uint64."""

    def generate(context, builder, signature, arguments):
        return builder.load(_pointer(context, builder, signature.args[0], *arguments), align=8)

    return VECTOR4(array, types.uint64), generate


@intrinsic
def store4(typingctx, array, index, vector):
    """Store a vector at ``array[index]`` and the three numbers after it."""

    def generate(context, builder, signature, arguments):
        builder.store(arguments[2], _pointer(context, builder, signature.args[0], *arguments[:2]), align=8)
        return context.get_dummy_value()

    return types.void(array, types.uint64, VECTOR4), generate


@intrinsic
def vector4(typingctx, a, b, c, d):
    """A vector of four numbers."""

    def generate(context, builder, signature, arguments):
        return _build(builder, arguments)

    return VECTOR4(*[types.float64] * 4), generate


@intrinsic
def add4(typingctx, a, b):
    """a + b, of vectors."""

    def generate(context, builder, signature, arguments):
        return builder.fadd(*arguments, flags=("contract",))

    return VECTOR4(VECTOR4, VECTOR4), generate


@intrinsic
def multiply4(typingctx, a, b):
    """a b, lane by lane."""

    def generate(context, builder, signature, arguments):
        return builder.fmul(*arguments, flags=("contract",))

    return VECTOR4(VECTOR4, VECTOR4), generate


@intrinsic
def scale4(typingctx, factor, vector):
    """A number times a vector."""

    def generate(context, builder, signature, arguments):
        return builder.fmul(_spread(builder, arguments[0]), arguments[1], flags=("contract",))

    return VECTOR4(types.float64, VECTOR4), generate


@intrinsic
def swap4(typingctx, vector):
    """(y, x, 0, 0) of (x, y, z, .)."""

    def generate(context, builder, signature, arguments):
        zero = ir.Constant(_FOUR, [0.0] * 4)
        return builder.shuffle_vector(arguments[0], zero, ir.Constant(ir.VectorType(_INDEX, 4), [1, 0, 4, 4]))

    return VECTOR4(VECTOR4), generate


@intrinsic
def next4(typingctx, vector):
    """(y, z, x, .) of (x, y, z, .)."""

    def generate(context, builder, signature, arguments):
        (vector,) = arguments
        return builder.shuffle_vector(vector, vector, ir.Constant(ir.VectorType(_INDEX, 4), [1, 2, 0, 3]))

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
def numbers4(typingctx, vector):
    """The four numbers of a vector, a tuple."""

    def generate(context, builder, signature, arguments):
        lanes = [_pick(builder, arguments[0], lane) for lane in range(4)]
        return context.make_tuple(builder, signature.return_type, lanes)

    return types.UniTuple(types.float64, 4)(VECTOR4), generate
