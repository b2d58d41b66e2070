"""How a driver says what it can do and tell; the description and the checks of arguments are made from it.

A value is a dict: name, type (`number`, `text`, `boolean`, `object`), unit (QUDT's short name), least, most, whole (no
fractions), options, title. A method is a dict: title, message (its message type) and parameters (a tuple of values).
"""

MOST_TEXT = 64


def number(name, least=None, most=None, unit="", title=""):
    """Return a number with its limits."""
    return {"name": name, "type": "number", "unit": unit, "least": least, "most": most, "title": title}


def count(name, least, most):
    """Return a number of things."""
    return {"name": name, "type": "number", "least": least, "most": most, "whole": True}


def boolean(name, title=""):
    """Return a value that is true or false."""
    return {"name": name, "type": "boolean", "title": title}


def choice(name, options, title=""):
    """Return a text that is one of a few."""
    return {"name": name, "type": "text", "options": options, "title": title}


def goods(name, options):
    """Return a kind of object that robots carry."""
    return {"name": name, "type": "object", "options": options}


def method(title, message="", *parameters):
    """Return a method."""
    return {"title": title, "message": message, "parameters": parameters}


def timed(title, longest_min):
    """Return a method that works for a number of minutes, called `time`."""
    return method(title, "time", number("time", 1, longest_min, "MIN"))


def hand_over(title, thing, most=24):
    """Return a method that gives or takes a number, called `value`, of a kind of object."""
    return method(title, "object", goods("object", (thing,)), count("value", 1, most))


def check_arguments(declared, values):
    """Return what is wrong with the arguments of a method, in a sentence, or an empty text."""
    names = [parameter["name"] for parameter in declared["parameters"]]
    for name in values:
        if name not in names:
            return "there is no argument %s" % name
    for parameter in declared["parameters"]:
        if values.get(parameter["name"]) is None:
            return "%s is missing" % parameter["name"]
        why = check_value(parameter, values[parameter["name"]])
        if why:
            return "%s must be %s" % (parameter["name"], why)
    return ""


def check_value(declared, value):
    """Return what a value must be when it is not, or an empty text."""
    if declared["type"] == "boolean":
        return "" if isinstance(value, bool) else "true or false"
    if declared["type"] != "number":
        options = declared.get("options")
        if options:
            return "" if value in options else "one of: " + ", ".join(options)
        return (
            "" if isinstance(value, str) and len(value) <= MOST_TEXT else "a text of at most %d characters" % MOST_TEXT
        )
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value != value:
        return "a number"
    least, most = declared["least"], declared["most"]
    if (least is not None and value < least) or (most is not None and value > most):
        return "from %s to %s" % (least, most)
    return "a whole number" if declared.get("whole") and value != int(value) else ""
