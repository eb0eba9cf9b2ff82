"""Words that no emitted name may be, and whose they are: languages, headers, and our own files.

A name of a scene stands in C after whatever headers its user includes, and as a variable in Python.
Macros that take arguments are no harm, for no name is followed by a parenthesis. What a board's
headers or complex.h have (``SP``, ``I``) is allowed: our headers put it aside (``emit/c/aside``).
"""

import keyword
import re
from collections.abc import Mapping

from derive.scene.functions import FUNCTIONS

_M = r"M_(1_PI|2_PI|2_SQRTPI|E|LN10|LN2|LOG10E|LOG2E|PI|PI_2|PI_4|SQRT1_2|SQRT2)(f|l|[fF][0-9]+x?)?"
_INTEGERS = (
    r"(U?(CHAR|SHRT|INT|LONG|LLONG)|SCHAR|S?SIZE|PTRDIFF|SIG_ATOMIC|WCHAR|WINT|MB_LEN|"
    r"U?INT(MAX|PTR|(_FAST|_LEAST)?(8|16|32|64)))_(MAX|MIN|WIDTH)"
)
_FAMILIES = (
    ("of C's math.h", _M),
    ("of C's math.h", r"HUGE_VAL[FL]?|HUGE_VAL_F[0-9]+X?|S?NAN[FL]?|SNANF[0-9]+X?|INFINITY"),
    ("of C's math.h", r"FP_[A-Z0-9_]{3,}"),
    ("of C's limits.h or stdint.h", _INTEGERS),
    ("of C's float.h", r"(FLT|DBL|LDBL|DEC[0-9]+)_[A-Z0-9_]+|DECIMAL_DIG"),
    ("of C's fenv.h", r"FE_[A-Z_]+"),
    ("of C's inttypes.h", r"(PRI|SCN)[bBdiouxX](FAST|LEAST|MAX|PTR)?(8|16|32|64)?"),
    ("of C's stdatomic.h", r"ATOMIC_[A-Z0-9_]+"),
    ("of C's locale.h", r"LC_[A-Z_]+"),
    ("of C's signal.h", r"SIG[A-Z0-9]{2,}|SIG_[A-Z]+"),
    ("of POSIX's signal.h", r"(BUS|CLD|FPE|ILL|POLL|SA|SEGV|SI|SIGEV|SS)_[A-Z0-9_]{2,}|s[ia]_\w+"),
    ("of POSIX's signal.h", r"MINSIGSTKSZ|NGREG|NSIG|sigev_notify_\w+"),
    ("of POSIX's time.h", r"CLOCK_[A-Z_]+|TIMER_ABSTIME"),
    (
        "of POSIX's limits.h",
        (
            r"(AIO_PRIO_DELTA|BC_BASE|BC_DIM|BC_SCALE|BC_STRING|CHARCLASS_NAME|COLL_WEIGHTS|"
            r"DELAYTIMER|EXPR_NEST|HOST_NAME|LINE|LOGIN_NAME|MQ_PRIO|NAME|NGROUPS|PATH|PTHREAD_KEYS|"
            r"RE_DUP|RTSIG|SEM_VALUE|TTY_NAME|XATTR_(LIST|NAME|SIZE)|IOV|ARG|OPEN|LINK)_MAX|"
            r"MAX_(CANON|INPUT)|PTHREAD_(DESTRUCTOR_ITERATIONS|STACK_MIN)|PIPE_BUF|NR_OPEN|"
            r"(LONG|WORD)_BIT|NL_[A-Z]+MAX|NZERO"
        ),
    ),
    ("of POSIX's stdlib.h", r"(BIG|LITTLE|PDP)_ENDIAN|BYTE_ORDER|FD_SETSIZE|NFDBITS"),
    ("of POSIX's stdlib.h", r"W(CONTINUED|EXITED|NOHANG|NOWAIT|STOPPED|UNTRACED)"),
    ("of Arduino.h", r"B[01]{1,8}|NUM_[A-Z]+_PINS|INTERNAL[0-9V]*"),
)
_WORDS: Mapping[str, str] = {
    "a word of C": "auto break case char const constexpr continue default do double else enum"
    " extern false float for goto if inline int long nullptr register restrict return short"
    " signed sizeof static static_assert struct switch thread_local true typedef typeof"
    " typeof_unqual union unsigned void volatile while alignas alignof bool asm"
    " noreturn complex imaginary NULL",
    "a word of C++": "and and_eq bitand bitor catch char8_t char16_t char32_t class co_await"
    " co_return co_yield compl concept const_cast consteval constinit decltype delete dynamic_cast"
    " explicit export friend mutable namespace new noexcept not not_eq operator or or_eq private"
    " protected public reinterpret_cast requires static_cast template this throw try typeid"
    " typename using virtual wchar_t xor xor_eq",
    "a function of a formula": " ".join(FUNCTIONS),
    "a function of C's math.h": "acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cosh erf"
    " erfc exp exp2 expm1 fabs fdim floor fma fmax fmin fmod frexp hypot ilogb isfinite isinf isnan"
    " ldexp lgamma log log10 log1p log2 logb lrint lround modf nan nearbyint nextafter pow"
    " remainder remquo rint round scalbln scalbn sinh tanh tgamma trunc"
    " sinf cosf sqrtf fabsf floorf atan2f",
    "a function of POSIX's math.h": "j0 j1 jn y0 y1 yn",
    "a function of C's stdlib.h or time.h": "abs div time",
    "a function of POSIX's strings.h": "index",
    "a macro of C's math.h": "MATH_ERRNO MATH_ERREXCEPT MAXFLOAT math_errhandling",
    "a macro of C's errno.h": "errno E2BIG EACCES EADDRINUSE EADDRNOTAVAIL EADV EAFNOSUPPORT EAGAIN"
    " EALREADY EBADE EBADF EBADFD EBADMSG EBADR EBADRQC EBADSLT EBFONT EBUSY ECANCELED ECHILD"
    " ECHRNG ECOMM ECONNABORTED ECONNREFUSED ECONNRESET EDEADLK EDEADLOCK EDESTADDRREQ EDOM"
    " EDOTDOT EDQUOT EEXIST EFAULT EFBIG EHOSTDOWN EHOSTUNREACH EHWPOISON EIDRM EILSEQ EINPROGRESS"
    " EINTR EINVAL EIO EISCONN EISDIR EISNAM EKEYEXPIRED EKEYREJECTED EKEYREVOKED EL2HLT EL2NSYNC"
    " EL3HLT EL3RST ELIBACC ELIBBAD ELIBEXEC ELIBMAX ELIBSCN ELNRNG ELOOP EMEDIUMTYPE EMFILE EMLINK"
    " EMSGSIZE EMULTIHOP ENAMETOOLONG ENAVAIL ENETDOWN ENETRESET ENETUNREACH ENFILE ENOANO ENOBUFS"
    " ENOCSI ENODATA ENODEV ENOENT ENOEXEC ENOKEY ENOLCK ENOLINK ENOMEDIUM ENOMEM ENOMSG ENONET"
    " ENOPKG ENOPROTOOPT ENOSPC ENOSR ENOSTR ENOSYS ENOTBLK ENOTCONN ENOTDIR ENOTEMPTY ENOTNAM"
    " ENOTRECOVERABLE ENOTSOCK ENOTSUP ENOTTY ENOTUNIQ ENXIO EOPNOTSUPP EOVERFLOW EOWNERDEAD EPERM"
    " EPFNOSUPPORT EPIPE EPROTO EPROTONOSUPPORT EPROTOTYPE ERANGE EREMCHG EREMOTE EREMOTEIO"
    " ERESTART ERFKILL EROFS ESHUTDOWN ESOCKTNOSUPPORT ESPIPE ESRCH ESRMNT ESTALE ESTRPIPE ETIME"
    " ETIMEDOUT ETOOMANYREFS ETXTBSY EUCLEAN EUNATCH EUSERS EWOULDBLOCK EXDEV EXFULL",
    "a macro of C's stdio.h": "BUFSIZ EOF FILENAME_MAX FOPEN_MAX L_ctermid L_cuserid L_tmpnam"
    " P_tmpdir SEEK_CUR SEEK_END SEEK_SET TMP_MAX stderr stdin stdout",
    "a macro of C's stdlib.h": "EXIT_FAILURE EXIT_SUCCESS MB_CUR_MAX RAND_MAX",
    "a macro of C's limits.h": "BOOL_WIDTH CHAR_BIT",
    "a macro of C's threads.h, time.h or wchar.h": "CLOCKS_PER_SEC ONCE_FLAG_INIT TIME_UTC"
    " TSS_DTOR_ITERATIONS WEOF",
    "a macro that compilers define": "linux unix i386 sun sparc mips m68k vax hpux PPC MIPSEB"
    " MIPSEL AVR WIN32 WIN64 WINNT",
    "a macro of Arduino.h": "CHANGE DEFAULT DEG_TO_RAD DISPLAY EULER EXTERNAL FALLING HALF_PI HIGH"
    " INPUT INPUT_PULLUP LED_BUILTIN LOW LSBFIRST MSBFIRST NOT_A_PIN NOT_A_PORT OUTPUT"
    " PI RAD_TO_DEG RISING SERIAL TWO_PI",
    "a macro of Windows.h": "CONST FALSE IN OPTIONAL OUT TRUE VOID far interface near small",
    "the name of CasADi in the emitted module": "ca",
    "a function of Python": "aiter all anext any ascii bin breakpoint bytearray bytes callable chr"
    " classmethod compile copyright credits delattr dict dir divmod enumerate eval exec exit filter"
    " format frozenset getattr globals hasattr hash help hex id input isinstance issubclass iter"
    " len license list locals map max memoryview min next object oct open ord print property quit"
    " range repr reversed set setattr slice sorted staticmethod str sum super tuple type vars zip",
}
_OWNERS = {
    **dict.fromkeys(keyword.kwlist, "a word of Python"),
    **{word: whose for whose, words in [*_WORDS.items()][::-1] for word in words.split()},
}
_DEVICE = re.compile(r"con|prn|aux|nul|com[0-9]|lpt[0-9]", re.IGNORECASE)


def owner(name: str) -> str:
    """Return whose word a name is, "" if it is nobody's.

    >>> owner("y1"), owner("SIGINT"), owner("mass")
    ("a function of POSIX's math.h", "a macro of C's signal.h", '')
    """
    families = (f"a macro {whose}" for whose, rule in _FAMILIES if re.fullmatch(rule, name))
    return _OWNERS.get(name) or next(families, "")


def is_device(name: str) -> bool:
    """Tell whether Windows takes a file of this name, whatever its ending, for a device."""
    return _DEVICE.fullmatch(name) is not None
