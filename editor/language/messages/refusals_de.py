"""Why a script is refused, and what to write instead, in German; `{…}` are the pieces that come from the script."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

REFUSALS_DE: Final[Mapping[str, str]] = {
    "“{x}”": "„{x}“",
    "The script is too long.": "Das Skript ist zu lang.",
    "Python says: {x}.": "Python sagt: {x}.",
    "It is nested too deeply, or no text.": "Es ist zu tief verschachtelt oder kein Text.",
    "It is nested too deeply.": "Es ist zu tief verschachtelt.",
    # what was found
    "This form of for": "Diese Form von for",
    "This form of try": "Diese Form von try",
    "A choice of one robot": "Eine Auswahl bei einem einzelnen Roboter",
    "This form of parameters": "Diese Form von Parametern",
    "This run": "Dieses run",
    "What is caught here": "Was hier gefangen wird",
    "A function called {x}": "Eine Funktion namens {x}",
    "A step as deep as this": "Ein so tiefer Schritt",
    "An expression as deep as this": "Ein so tiefer Ausdruck",
    "A task without this method": "Eine Aufgabe ohne diese Methode",
    "A pick or drop at an unknown place": "Ein Aufnehmen oder Ablegen an unbekanntem Ort",
    "An event with parameters": "Ein Ereignis mit Parametern",
    "A script without class Task": "Ein Skript ohne class Task",
    "A second method {x}": "Eine zweite Methode {x}",
    "The variable “{x}”": "Die Variable „{x}“",
    "A change of “{x}”": "Eine Änderung von „{x}“",
    "The name {x}": "Der Name {x}",
    "A zone without a rule": "Eine Zone ohne Regel",
    "A passage without a door": "Ein Durchgang ohne Tür",
    # what to write instead
    "A zone takes rule, door, speed and name. {x}": "Eine Zone hat rule, door, speed und name. {x}",
    "Add the id of the device that opens: {x}.": "Ergänzen Sie die Kennung des Geräts, das öffnet: {x}.",
    "Write the id of the device that opens: {x}.": "Schreiben Sie die Kennung des Geräts, das öffnet: {x}.",
    "Only a passage has a door: {x}.": "Nur ein Durchgang hat eine Tür: {x}.",
    "Write the corners as a list of points: {x}.": "Schreiben Sie die Ecken als Liste von Punkten: {x}.",
    "A zone has at least {x} corners.": "Eine Zone hat mindestens {x} Ecken.",
    "A zone has at most {x} corners.": "Eine Zone hat höchstens {x} Ecken.",
    "These corners enclose no area. Move one of them off the line of the others.": "Diese Ecken umschließen keine "
    "Fläche. Rücken Sie eine davon von der Linie der anderen weg.",
    "Add what robots do there: {x}. {y}": "Ergänzen Sie, was Roboter dort tun: {x}. {y}",
    "Write the speed in m/s, above 0: {x}.": "Schreiben Sie die Geschwindigkeit in m/s, über 0: {x}.",
    "Write what people call the zone: {x}.": "Schreiben Sie, wie die Zone heißt: {x}.",
    "Write another text here for this zone.": "Schreiben Sie hier für diese Zone einen anderen Text.",
    "Use the robots' move, pick and drop, machines' methods, wait, ask, notify, if, while, for, try, parallel, "
    "variables and functions.": "Verwenden Sie move, pick und drop von Robotern, Methoden von Maschinen, wait, ask, "
    "notify, if, while, for, try, parallel, Variablen und Funktionen.",
    "Write the names of arguments as texts.": "Schreiben Sie die Namen der Argumente als Texte.",
    "Set a variable by its name: {x}.": "Setzen Sie eine Variable mit ihrem Namen: {x}.",
    "Only variables can be set: {x}.": "Nur Variablen können gesetzt werden: {x}.",
    "Call a function by its name: {x}.": "Rufen Sie eine Funktion mit ihrem Namen auf: {x}.",
    "Write quantity(10, \"min\"), with one of these units: {x}.": "Schreiben Sie quantity(10, \"min\"), mit einer "
    "dieser Einheiten: {x}.",
    "Write a point as (x, y) in metres.": "Schreiben Sie einen Punkt als (x, y) in Metern.",
    "Write a point as {x}, in metres.": "Schreiben Sie einen Punkt als {x}, in Metern.",
    "Write where it goes as {x}, or as a point (x, y).": "Schreiben Sie das Ziel als {x} oder als Punkt (x, y).",
    "Write it in several steps.": "Schreiben Sie es in mehreren Schritten.",
    "Write a number, a text, True or False here.": "Schreiben Sie hier eine Zahl, einen Text, True oder False.",
    "Write a number below 10¹⁵, a text, True or False here.": "Schreiben Sie hier eine Zahl unter 10¹⁵, einen Text, "
    "True oder False.",
    "Write at least one value between the brackets.": "Schreiben Sie mindestens einen Wert in die Klammern.",
    "Write self.parallel({x}), a method for each branch.": "Schreiben Sie self.parallel({x}), eine Methode für jeden "
    "Zweig.",
    "A further except": "Ein weiteres except",
    "A try takes up to 8. Let one of them catch several kinds: except (Offline, TimedOut):": "Ein try hat bis zu 8. "
    "Lassen Sie eines mehrere Arten fangen: except (Offline, TimedOut):",
    "Write def {x} in class Task.": "Schreiben Sie def {x} in class Task.",
    "Write {x}, or {y}.": "Schreiben Sie {x} oder {y}.",
    "Write {x}: or {y}:.": "Schreiben Sie {x}: oder {y}:.",
    "Write {x}": "Schreiben Sie {x}",
    "Call it {x}.": "Nennen Sie es {x}.",
    "Catch TaskError, or some of: {x}.": "Fangen Sie TaskError, oder einige von: {x}.",
    "Make a function of some of the steps.": "Machen Sie aus einigen der Schritte eine Funktion.",
    "What it can do: {x}.": "Was es kann: {x}.",
    "There is no such function. Functions of this task: {x}.": "Diese Funktion gibt es nicht. Funktionen dieser "
    "Aufgabe: {x}.",
    "Each branch needs a method of its own; {x} is none.": "Jeder Zweig braucht eine eigene Methode; {x} ist keine.",
    "Each event needs a method of its own: {x}.": "Jedes Ereignis braucht eine eigene Methode: {x}.",
    "Put {x} before it.": "Setzen Sie {x} davor.",
    "Begin with class Task(object): and put everything in it.": "Beginnen Sie mit class Task(object): und setzen Sie "
    "alles hinein.",
    "Give it in run: {x}.": "Geben Sie es in run an: {x}.",
    "Give it another name.": "Geben Sie ihr einen anderen Namen.",
    "In the class there are only methods.": "In der Klasse stehen nur Methoden.",
    "Write {x}, where=lambda robot: robot.battery > 30).": (
        "Schreiben Sie {x}, where=lambda robot: robot.battery > 30)."
    ),
    "A choice looks only at what the robot itself reports, such as robot.battery > 30.": (
        "Eine Auswahl sieht nur, was der Roboter selbst meldet, wie robot.battery > 30."
    ),
    "Say what it reports: {x}.battery > 30.": "Nennen Sie, was er meldet: {x}.battery > 30.",
    "In run, write {x} and {y}.": "Schreiben Sie in run {x} und {y}.",
    "In expressions only these can be called: {x}.": "In Ausdrücken können nur diese aufgerufen werden: {x}.",
    "Use readings of devices, parameters, numbers, texts and comparisons.": "Verwenden Sie Messwerte von Geräten, "
    "Parameter, Zahlen, Texte und Vergleiche.",
    "Use a parameter of this function, or a reading such as {x}.": "Verwenden Sie einen Parameter dieser Funktion oder "
    "einen Messwert wie {x}.",
    "Use “not” or “-”.": "Verwenden Sie „not“ oder „-“.",
    "Use {x} or {y}.": "Verwenden Sie {x} oder {y}.",
    "Write for example: oven.temperature.": "Schreiben Sie zum Beispiel: oven.temperature.",
    "What can be read here: {x}.": "Was hier gelesen werden kann: {x}.",
    "{x} takes {y} value(s).": "{x} nimmt {y} Werte.",
    "{x} takes {y}.": "{x} nimmt {y}.",
    "Compare two values at a time, and join comparisons with “and”.": "Vergleichen Sie je zwei Werte und verbinden Sie "
    "Vergleiche mit „and“.",
    "Here {x} is something else, which hides it. Write {y}.": "Hier ist {x} etwas anderes, das es verdeckt. Schreiben "
    "Sie {y}.",
    "Here {x} is something else. Write {y}.": "Hier ist {x} etwas anderes. Schreiben Sie {y}.",
    "Between {x} and {y} write only the value.": "Schreiben Sie zwischen {x} und {y} nur den Wert.",
    "type is one of {x}; unit, minimum and maximum go with \"number\", {y} with \"choice\".": "type ist eines von {x}; "
    "unit, minimum und maximum gehören zu \"number\", {y} zu \"choice\".",
    "This name stands for something else. Choose another.": "Dieser Name steht für etwas anderes. Wählen Sie einen "
    "anderen.",
    "It belongs to this function alone. Write {x}.": "Sie gehört nur zu dieser Funktion. Schreiben Sie {x}.",
}  # fmt: skip
"""Where several fit, the first one holds."""
