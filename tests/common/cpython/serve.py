import math
import struct
import sys
from array import array

# words of four bytes, then numbers of eight, as the machine has them
heard, said = sys.stdin.buffer, sys.stdout.buffer


def bits(word):
    return struct.unpack("<d", struct.pack("<Q", word))[0]


def word(number):
    return struct.unpack("<Q", struct.pack("<d", number))[0]


def words(count):
    return struct.unpack(f"={count}I", heard.read(4 * count))


def numbers(count):
    return array("d", heard.read(8 * count)).tolist()


def say(name, values):
    said.write(struct.pack("=2I", len(name), len(values)) + name + array("d", values).tobytes())
    said.flush()


def asked(name, *at):
    say(name, at)
    (count,) = words(1)
    return numbers(count)


# Python raises where IEEE 754 has a value
def divided(a, b):
    if b != 0.0:
        return a / b
    if a == 0.0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, math.copysign(1.0, a) * math.copysign(1.0, b))


def root(a):
    return math.sqrt(a) if a >= 0.0 else math.nan


(length,) = words(1)
exec(heard.read(length))
while True:
    code, *counts = words(9)
    # of what is stored no name is said
    say(b"", globals()[f"code_{code}"]([numbers(count) for count in counts]))
