"""Which small changes of one node of a syntax tree are tried? Those of mutmut and Cosmic Ray, and pairs of names."""

import ast
from collections.abc import Callable, Iterator

Change = tuple[str, Callable[[], ast.AST]]
"""Name of an operator, and what makes the changed node; the node itself stays as it is."""

IDLE = {"strict", "optimize", "overwrite_a", "overwrite_b", "check_finite"}  # keywords that change speed or checks only
TOLERANCE = 1e-5  # smaller numbers are tolerances and guards against a division by zero, not part of a formula
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Div,
    ast.Mod: ast.Div,
    ast.Pow: ast.Mult,
    ast.MatMult: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.BitXor: ast.BitAnd,
}
PAIRS = (
    ("min", "max"), ("minimum", "maximum"), ("argmin", "argmax"), ("nanmin", "nanmax"), ("any", "all"), ("sin", "cos"),
    ("sinh", "cosh"), ("zeros", "ones"), ("zeros_like", "ones_like"), ("logical_and", "logical_or"), ("real", "imag"),
    ("floor", "ceil"), ("sum", "prod"),
)  # fmt: skip
NAMES = {one: other for pair in PAIRS for one, other in (pair, pair[::-1])}


def like(node: ast.AST, **fields: object) -> ast.AST:
    """A copy of a node at its place with other fields."""
    kept = {name: getattr(node, name) for name in node._fields if hasattr(node, name)}
    return ast.copy_location(type(node)(**(kept | fields)), node)


def placed(new: ast.AST, old: ast.AST) -> ast.AST:
    return ast.fix_missing_locations(ast.copy_location(new, old))


def changes(node: ast.AST) -> Iterator[Change]:
    """Every change that one node allows."""
    for kinds, of in MAKERS:
        if isinstance(node, kinds):
            yield from of(node)


def _compare(node: ast.Compare) -> Iterator[Change]:
    for place, op in enumerate(node.ops):
        for other in COMPARISONS[type(op)]:
            ops = [*node.ops[:place], other(), *node.ops[place + 1 :]]
            yield "comparison", lambda ops=ops: like(node, ops=ops)


def _arithmetic(node: ast.BinOp | ast.AugAssign) -> Iterator[Change]:
    if (other := ARITHMETIC.get(type(node.op))) is not None:
        yield "arithmetic", lambda: like(node, op=other())


def _unary(node: ast.UnaryOp) -> Iterator[Change]:
    if not isinstance(node.op, ast.UAdd):
        yield "sign or not", lambda: node.operand


def _logic(node: ast.BoolOp) -> Iterator[Change]:
    yield "and, or", lambda: like(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())


def _constant(node: ast.Constant) -> Iterator[Change]:
    value = node.value
    if isinstance(value, bool):
        yield "constant", lambda: like(node, value=not value)
    elif isinstance(value, int):
        yield "constant", lambda: like(node, value=value + 1)
    elif isinstance(value, float) and not 0.0 < value < TOLERANCE:
        yield "constant", lambda: like(node, value=2.0 * value if value else 1.0)


def _condition(node: ast.If | ast.IfExp | ast.While) -> Iterator[Change]:
    if not isinstance(node.test, ast.Compare | ast.UnaryOp):  # these have changes of their own
        opposite = placed(ast.UnaryOp(ast.Not(), node.test), node.test)
        yield "condition", lambda: like(node, test=opposite)


def _call(node: ast.Call) -> Iterator[Change]:
    for place, keyword in enumerate(node.keywords):
        if keyword.arg in IDLE:
            continue
        rest = [*node.keywords[:place], *node.keywords[place + 1 :]]
        yield "argument left out", lambda rest=rest: like(node, keywords=rest)


def _named(node: ast.Attribute | ast.Name) -> Iterator[Change]:
    field = "attr" if isinstance(node, ast.Attribute) else "id"
    if isinstance(node.ctx, ast.Load) and (other := NAMES.get(getattr(node, field))):
        yield "function", lambda: like(node, **{field: other})


def _statement(node: ast.stmt) -> Iterator[Change]:
    if isinstance(node, ast.Raise) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)):
        yield "statement left out", lambda: placed(ast.Pass(), node)
    elif isinstance(node, ast.Break):
        yield "break, continue", lambda: placed(ast.Continue(), node)
    elif isinstance(node, ast.Continue):
        yield "break, continue", lambda: placed(ast.Break(), node)


MAKERS: tuple[tuple[tuple[type[ast.AST], ...], Callable[..., Iterator[Change]]], ...] = (
    ((ast.Compare,), _compare),
    ((ast.BinOp, ast.AugAssign), _arithmetic),
    ((ast.UnaryOp,), _unary),
    ((ast.BoolOp,), _logic),
    ((ast.Constant,), _constant),
    ((ast.If, ast.IfExp, ast.While), _condition),
    ((ast.Call,), _call),
    ((ast.Attribute, ast.Name), _named),
    ((ast.Raise, ast.Expr, ast.Break, ast.Continue), _statement),
)
