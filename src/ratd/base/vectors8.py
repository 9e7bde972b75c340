"""Eight numbers computed as one, for blocks of six that are padded with zeros (`ratd.engine.block_factor`)."""

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic, models, register_model

_EIGHT = ir.VectorType(ir.DoubleType(), 8)
_INDEX = ir.IntType(32)


class Vector8(types.Type):
    """The type of such a vector in compiled code."""

    def __init__(self):
        super().__init__(name="Vector8")


VECTOR8 = Vector8()


@register_model(Vector8)
class _Vector8Model(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, _EIGHT)


def _pointer(context, builder, kind, array, index):
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), _EIGHT.as_pointer())


@intrinsic
def load8(typingctx, array, index):
    """The vector that begins at ``array[index]``; `index` is a uint64."""

    def generate(context, builder, signature, arguments):
        return builder.load(_pointer(context, builder, signature.args[0], *arguments), align=8)

    return VECTOR8(array, types.uint64), generate


@intrinsic
def store8(typingctx, array, index, vector):
    """Store a vector at ``array[index]`` and the seven numbers after it."""

    def generate(context, builder, signature, arguments):
        builder.store(arguments[2], _pointer(context, builder, signature.args[0], *arguments[:2]), align=8)
        return context.get_dummy_value()

    return types.void(array, types.uint64, VECTOR8), generate


@intrinsic
def spread8(typingctx, number):
    """A vector of eight times the same number."""

    def generate(context, builder, signature, arguments):
        vector = builder.insert_element(ir.Constant(_EIGHT, ir.Undefined), arguments[0], ir.Constant(_INDEX, 0))
        return builder.shuffle_vector(vector, vector, ir.Constant(ir.VectorType(_INDEX, 8), [0] * 8))

    return VECTOR8(types.float64), generate


@intrinsic
def add8(typingctx, a, b):
    """a + b, of vectors."""

    def generate(context, builder, signature, arguments):
        return builder.fadd(*arguments, flags=("contract",))

    return VECTOR8(VECTOR8, VECTOR8), generate


@intrinsic
def subtract8(typingctx, a, b):
    """a - b, of vectors."""

    def generate(context, builder, signature, arguments):
        return builder.fsub(*arguments, flags=("contract",))

    return VECTOR8(VECTOR8, VECTOR8), generate


@intrinsic
def multiply8(typingctx, a, b):
    """a b, lane by lane."""

    def generate(context, builder, signature, arguments):
        return builder.fmul(*arguments, flags=("contract",))

    return VECTOR8(VECTOR8, VECTOR8), generate


@intrinsic
def sum8(typingctx, vector):
    """The sum of the eight numbers, by halves."""

    def generate(context, builder, signature, arguments):
        (vector,) = arguments
        size = 8
        while size > 1:
            size //= 2
            low = ir.Constant(ir.VectorType(_INDEX, size), list(range(size)))
            high = ir.Constant(ir.VectorType(_INDEX, size), list(range(size, 2 * size)))
            vector = builder.fadd(
                builder.shuffle_vector(vector, vector, low), builder.shuffle_vector(vector, vector, high)
            )
        return builder.extract_element(vector, ir.Constant(_INDEX, 0))

    return types.float64(VECTOR8), generate
