"""What goes wrong inside the library, as an exception."""

from enum import IntEnum


class ErrorCode(IntEnum):
    """The library's return codes. A value never changes its meaning."""

    NULL = -1
    CONFIG = -2
    STRUCT_SIZE = -3
    ARENA = -10
    OUT_OF_MEMORY = -11
    NO_HEAP = -12
    THREAD = -13
    FRAME = -20
    BOX = -21
    NOT_STARTED = -22
    RANGE = -23
    BACKEND = -30
    BUFFER = -40
    CORRUPT = -41
    MISMATCH = -42


class AstError(Exception):
    """The library refused a call. The tracker is as it was before the call.

    Attributes:
        code: the library's return code, an `ErrorCode` where this package knows it.
        field: the configuration field at fault when `code` is `ErrorCode.CONFIG`, otherwise None.
    """

    code: int
    field: str | None

    def __init__(self, code: int, message: str, field: str | None = None) -> None:
        # All three are args, so that the exception survives the pickling between processes.
        super().__init__(code, message, field)
        try:
            self.code = ErrorCode(code)
        except ValueError:
            self.code = code
        self.field = field
        self._message = message

    def __str__(self) -> str:
        return self._message
