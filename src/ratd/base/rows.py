"""Eight rows of memory as columns in vector registers, and back.

The compiler does not find these by itself: it moves the numbers of a row one by one, and the processor can store one
number a cycle. Eight rows of eight are turned into eight vectors by shuffles instead.
"""

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.errors import TypingError
from numba.extending import intrinsic

EIGHT = 8
LINE = 8
"""Numbers in a line of the cache."""
_DOUBLE = ir.DoubleType()
_VECTOR = ir.VectorType(_DOUBLE, EIGHT)
_HALF = ir.VectorType(_DOUBLE, EIGHT // 2)


def _shuffle(builder, a, b, picks):
    mask = ir.Constant(ir.VectorType(ir.IntType(32), len(picks)), picks)
    return builder.shuffle_vector(a, b, mask)


def _transposed(builder, rows):
    """The columns of eight rows: neighbours interleaved, then pieces of two, then pieces of four."""
    low = [_shuffle(builder, a, b, [0, 8, 2, 10, 4, 12, 6, 14]) for a, b in zip(rows[::2], rows[1::2], strict=True)]
    high = [_shuffle(builder, a, b, [1, 9, 3, 11, 5, 13, 7, 15]) for a, b in zip(rows[::2], rows[1::2], strict=True)]
    even, odd = [0, 1, 4, 5, 8, 9, 12, 13], [2, 3, 6, 7, 10, 11, 14, 15]
    columns = [None] * EIGHT
    for first, pairs in enumerate((low, high)):
        for second, lanes in enumerate((even, odd)):
            top = _shuffle(builder, pairs[0], pairs[1], lanes)
            bottom = _shuffle(builder, pairs[2], pairs[3], lanes)
            columns[first + 2 * second] = _shuffle(builder, top, bottom, even)
            columns[first + 2 * second + 4] = _shuffle(builder, top, bottom, odd)
    return columns


def _pointer(builder, data, index, kind):
    return builder.bitcast(builder.gep(data, [index]), kind.as_pointer())


def _load(builder, data, index, kind=_VECTOR):
    return builder.load(_pointer(builder, data, index, kind), align=8)


def _store(builder, value, data, index):
    builder.store(value, _pointer(builder, data, index, value.type), align=8)


def _data(context, builder, signature, arguments):
    """The pointers to the numbers of all arrays among the arguments, and the other arguments as they are."""
    return [
        context.make_array(kind)(context, builder, value).data if isinstance(kind, types.Array) else value
        for kind, value in zip(signature.args, arguments, strict=True)
    ]


def _check(name, arrays, indices):
    for kind in arrays:
        if not (isinstance(kind, types.Array) and kind.ndim == 1 and kind.layout == "C"):
            raise TypingError(f"{name} takes flat contiguous arrays, not {kind}")
    for kind in indices:
        if kind != types.uint64:
            raise TypingError(f"{name} takes unsigned indices, not {kind}")


def _index(value):
    return ir.Constant(ir.IntType(64), value)


@intrinsic
def gather_differences(typingctx, rows, first, second, begin, columns, at, stride):
    """Rows ``first`` minus rows ``second``, as columns: numbers 0, 1, 2, 4, 5, 6 of eight rows.

    Number c of pair l goes to ``columns[at + c' * stride + l]``, c' = 0 ... 5.

    Parameters
    ----------
    rows : (m,) float64 array
    first, second : (k,) uint64 arrays
        Where the rows of each pair begin in `rows`, in units of 16 numbers.
    begin : uint64
        First of the eight pairs.
    columns : (n,) float64 array
    at, stride : uint64
    """
    _check("gather_differences", (rows, first, second, columns), (begin, at, stride))
    signature = types.void(rows, first, second, begin, columns, at, stride)

    def generate(context, builder, signature, arguments):
        rows, first, second, begin, columns, at, stride = _data(context, builder, signature, arguments)
        found = []
        for lane in range(EIGHT):
            pair = builder.add(begin, _index(lane))
            i, j = (builder.shl(builder.load(builder.gep(side, [pair])), _index(4)) for side in (first, second))
            found.append(builder.fsub(_load(builder, rows, i), _load(builder, rows, j)))
        _store_columns(builder, found, columns, at, stride)
        return context.get_dummy_value()

    return signature, generate


@intrinsic
def gather_sides(typingctx, rows, first, second, begin, columns, at, stride):
    """Numbers 8, 9, 10 of rows ``first`` and then of rows ``second``, as columns; else like `gather_differences`."""
    _check("gather_sides", (rows, first, second, columns), (begin, at, stride))
    signature = types.void(rows, first, second, begin, columns, at, stride)

    def generate(context, builder, signature, arguments):
        rows, first, second, begin, columns, at, stride = _data(context, builder, signature, arguments)
        found = []
        for lane in range(EIGHT):
            pair = builder.add(begin, _index(lane))
            halves = []
            for side in (first, second):
                row = builder.shl(builder.load(builder.gep(side, [pair])), _index(4))
                halves.append(_load(builder, rows, builder.add(row, _index(8)), _HALF))
            found.append(_shuffle(builder, *halves, list(range(EIGHT))))
        _store_columns(builder, found, columns, at, stride)
        return context.get_dummy_value()

    return signature, generate


def _store_columns(builder, rows, columns, at, stride):
    """Columns 0, 1, 2, 4, 5, 6 of eight rows, stored at `at` and every `stride` after."""
    turned = _transposed(builder, rows)
    for number, column in enumerate((0, 1, 2, 4, 5, 6)):
        _store(builder, turned[column], columns, builder.add(at, builder.mul(stride, _index(number))))


def _quarter_rows(builder, x, y, z):
    """Three columns as eight short rows (x, y, z, 0)."""
    nothing = ir.Constant(_VECTOR, [0.0] * EIGHT)
    low, high = [0, 8, 2, 10, 4, 12, 6, 14], [1, 9, 3, 11, 5, 13, 7, 15]
    rows = [None] * EIGHT
    for first, picks in enumerate((low, high)):
        left = _shuffle(builder, x, y, picks)
        right = _shuffle(builder, z, nothing, picks)
        # of each two of four numbers: rows 0, 4 and 2, 6, or 1, 5 and 3, 7
        for second, halves in enumerate(([0, 1, 8, 9, 4, 5, 12, 13], [2, 3, 10, 11, 6, 7, 14, 15])):
            both = _shuffle(builder, left, right, halves)
            for third, part in enumerate(([0, 1, 2, 3], [4, 5, 6, 7])):
                rows[first + 2 * second + 4 * third] = _shuffle(builder, both, both, part)
    return rows


@intrinsic
def add_forces(typingctx, rows, first, second, begin, columns, at, stride):
    """Add nine columns of eight pairs to rows of eight numbers, one pair after the other; a row may come twice.

    The columns are a force on the first of a pair, and torques on the first and on the second: the force is added to
    numbers 0, 1, 2 of the row of the first, and subtracted from those of the second; the torques are added to numbers
    4, 5, 6.

    Parameters
    ----------
    rows : (m,) float64 array
    first, second : (k,) uint64 arrays
        Where the rows of each pair begin in `rows`, in units of 8 numbers.
    begin : uint64
        First of the eight pairs.
    columns : (n,) float64 array
    at : uint64
        Where the columns begin.
    stride : uint64
        From one column to the next.
    """
    _check("add_forces", (rows, first, second, columns), (begin, at, stride))
    signature = types.void(rows, first, second, begin, columns, at, stride)

    def generate(context, builder, signature, arguments):
        rows, first, second, begin, columns, at, stride = _data(context, builder, signature, arguments)
        values = [_load(builder, columns, builder.add(at, builder.mul(stride, _index(number)))) for number in range(9)]
        force, torque_i, torque_j = (_quarter_rows(builder, *values[k : k + 3]) for k in (0, 3, 6))
        for lane in range(EIGHT):
            for index, join, torque in ((first, builder.fadd, torque_i), (second, builder.fsub, torque_j)):
                place = builder.shl(builder.load(builder.gep(index, [builder.add(begin, _index(lane))])), _index(3))
                half = builder.add(place, _index(4))
                _store(builder, join(_load(builder, rows, place, _HALF), force[lane]), rows, place)
                _store(builder, builder.fadd(_load(builder, rows, half, _HALF), torque[lane]), rows, half)
        return context.get_dummy_value()

    return signature, generate


@intrinsic
def call_line(typingctx, numbers, at):
    """Have the processor bring the line of the cache that holds ``numbers[at]`` nearer, without waiting for it.

    It goes to the second-level cache: the first one is full of what is being worked on.

    Parameters
    ----------
    numbers : (m,) array
    at : uint64
        May lie beyond the end, where nothing happens.
    """
    _check("call_line", (numbers,), (at,))
    signature = types.void(numbers, at)

    def generate(context, builder, signature, arguments):
        data, at = _data(context, builder, signature, arguments)
        byte, number = ir.IntType(8), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte.as_pointer(), number, number, number])
        prefetch = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        to_read, second_level, data_not_code = number(0), number(2), number(1)
        builder.call(prefetch, [_pointer(builder, data, at, byte), to_read, second_level, data_not_code])
        return context.get_dummy_value()

    return signature, generate
