import math
import struct
import sys


def bits(word):
    return struct.unpack("<d", struct.pack("<Q", word))[0]


def word(number):
    return struct.unpack("<Q", struct.pack("<d", number))[0]


def digits(numbers):
    return " ".join(str(word(x)) for x in numbers)


def numbers(text):
    return [bits(int(word)) for word in text.split()]


def say(name, values):
    sys.stdout.write(f"{name};{digits(values)}\n")
    sys.stdout.flush()


def asked(name, *at):
    say(name, at)
    return numbers(sys.stdin.readline())


# Python raises where IEEE 754 has a value
def divided(a, b):
    if b != 0.0:
        return a / b
    if a == 0.0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, math.copysign(1.0, a) * math.copysign(1.0, b))


def root(a):
    return math.sqrt(a) if a >= 0.0 else math.nan


count = int(sys.stdin.readline())
exec("".join(sys.stdin.readline() for _ in range(count)))
for line in sys.stdin:
    code, *slices = line.split(";")
    say("stored", globals()[f"code_{code}"]([numbers(text) for text in slices]))
