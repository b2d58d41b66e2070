"""What to write instead of the most frequent mistakes, in German; `{…}` are the pieces that come from the script."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

MISTAKES_DE: Final[Mapping[str, str]] = {
    "{x} Choose another name for the variable.": "{x} Wählen Sie für die Variable einen anderen Namen.",
    "Leave it out: a script uses only what self and ctx give.": "Lassen Sie es weg: Ein Skript verwendet nur, was self "
    "und ctx geben.",
    "Write functions beside new_task, in class Task: def mix_paint(self, minutes):.": "Schreiben Sie Funktionen neben "
    "new_task, in class Task: def mix_paint(self, minutes):.",
    "A script has one class, Task. Write a function instead: def mix_paint(self):.": "Ein Skript hat eine Klasse, "
    "Task. Schreiben Sie stattdessen eine Funktion: def mix_paint(self):.",
    'Write with self.limit(quantity(5, "min")): and under it the steps that may take so long.': "Schreiben Sie "
    'with self.limit(quantity(5, "min")): und darunter die Schritte, die so lange dauern dürfen.',
    "Leave “with” out and write its lines as they are.": "Lassen Sie „with“ weg und schreiben Sie seine Zeilen so, "
    "wie sie sind.",
    "Write if, and inside it self.notify(…) or self.end().": "Schreiben Sie if und darin self.notify(…) oder "
    "self.end().",
    "Leave it out: nothing needs to be deleted.": "Lassen Sie es weg: Nichts muss gelöscht werden.",
    "Leave it out: self.count is seen everywhere.": "Lassen Sie es weg: self.count ist überall bekannt.",
    "Write if and else instead.": "Schreiben Sie stattdessen if und else.",
    "Write a function beside new_task, in class Task: def mix_paint(self, minutes):.": "Schreiben Sie eine Funktion "
    "neben new_task, in class Task: def mix_paint(self, minutes):.",
    "Write the values one by one, or for oven in [self.oven_a, self.oven_b]:.": "Schreiben Sie die Werte einzeln, oder "
    "for oven in [self.oven_a, self.oven_b]:.",
    "Write if and else on lines of their own.": "Schreiben Sie if und else in eigene Zeilen.",
    "Set the variable on a line of its own: self.count = 1.": "Setzen Sie die Variable in einer eigenen Zeile: "
    "self.count = 1.",
    "Take one item at a time: {x}.": "Nehmen Sie einen Eintrag auf einmal: {x}.",
    'Write a text with the value in it: f"{self.count} boxes".': "Schreiben Sie einen Text mit dem Wert darin: "
    'f"{{self.count}} boxes".',
    "Items are counted from 1. Write {x}.": "Einträge werden von 1 an gezählt. Schreiben Sie {x}.",
    "Leave “await” out: a script waits by itself until a step is done.": "Lassen Sie „await“ weg: Ein Skript wartet "
    "von selbst, bis ein Schritt fertig ist.",
    "Write return to give a value.": "Schreiben Sie return, um einen Wert zu geben.",
    "Write the values one by one.": "Schreiben Sie die Werte einzeln.",
    "Only pick, drop and operate take values in braces.": "Nur pick, drop und operate nehmen Werte in geschweiften "
    "Klammern.",
    "Write a list with square brackets: [1, 2].": "Schreiben Sie eine Liste mit eckigen Klammern: [1, 2].",
    'Tell people by self.notify("The box is dry.").': 'Sagen Sie es Menschen mit self.notify("The box is dry.").',
    'Ask people by self.dry = self.ask("Is it dry?", type="boolean").': "Fragen Sie Menschen mit "
    'self.dry = self.ask("Is it dry?", type="boolean").',
    "Wait by self.wait(60).": "Warten Sie mit self.wait(60).",
    "Write it in an except that names it: except TaskError as problem:.": "Schreiben Sie es in ein except, das ihm "
    "einen Namen gibt: except TaskError as problem:.",
    'Write raise Failed("The box is wet.").': 'Schreiben Sie raise Failed("Die Kiste ist nass.").',
    "End the program by self.end().": "Beenden Sie das Programm mit self.end().",
    "Write self. before it: {x}": "Schreiben Sie self. davor: {x}",
    "Write the steps themselves.": "Schreiben Sie die Schritte selbst.",
    "Write the value itself.": "Schreiben Sie den Wert selbst.",
    "A script reads no files. Use readings of devices, parameters and questions.": "Ein Skript liest keine Dateien. "
    "Verwenden Sie Messwerte von Geräten, Parameter und Fragen.",
    "Use round(…), or write the number.": "Verwenden Sie round(…) oder schreiben Sie die Zahl.",
    "Leave “float” out and write the value.": "Lassen Sie „float“ weg und schreiben Sie den Wert.",
    "Say what it does, for example {x} or {y}.": "Sagen Sie, was es tut, zum Beispiel {x} oder {y}.",
    "Put it where it is used, or keep it: self.count = 5.": "Setzen Sie es dorthin, wo es gebraucht wird, oder "
    "behalten Sie es: self.count = 5.",
    # where Python cannot read on
    "The bracket {x} is never closed. Close it behind its content.": "Die Klammer {x} wird nie geschlossen. Schließen "
    "Sie sie hinter ihrem Inhalt.",
    "The bracket {x} was never opened. Take it away, or open it before.": "Die Klammer {x} wurde nie geöffnet. Nehmen "
    "Sie sie weg oder öffnen Sie sie davor.",
    "The bracket {x} closes another one than the last. Close that first.": "Die Klammer {x} schließt eine andere als "
    "die letzte. Schließen Sie erst diese.",
    "Indent with spaces, 4 for each level, not with tabs.": "Rücken Sie mit Leerzeichen ein, 4 je Ebene, nicht mit "
    "Tabulatoren.",
    "Indent with 4 spaces for each level, like the lines beside it.": "Rücken Sie mit 4 Leerzeichen je Ebene ein, wie "
    "die Zeilen daneben.",
    "Indent by 4 spaces what belongs to the line before it, or write pass.": "Rücken Sie um 4 Leerzeichen ein, was zur "
    "Zeile davor gehört, oder schreiben Sie pass.",
    'Write straight quotation marks: "box".': 'Schreiben Sie gerade Anführungszeichen: "box".',
    "There is a character here that cannot be seen. Delete it; type a space.": "Hier ist ein unsichtbares Zeichen. "
    "Löschen Sie es und setzen Sie ein Leerzeichen.",
    "The character {x} belongs only into texts. Delete it.": "Das Zeichen {x} gehört nur in Texte. Löschen Sie es.",
    "Compare with ==; a single = sets a variable.": "Vergleichen Sie mit ==; ein einzelnes = setzt eine Variable.",
    "Write a colon at the end of this line.": "Schreiben Sie einen Doppelpunkt ans Ende dieser Zeile.",
    "Close the text with a quotation mark on its line.": "Schließen Sie den Text mit einem Anführungszeichen in "
    "seiner Zeile.",
    "Write except TaskError as problem: or finally: behind try.": "Schreiben Sie except TaskError as problem: oder "
    "finally: hinter try.",
    "Write a comma between the values.": "Schreiben Sie ein Komma zwischen die Werte.",
    "Only variables can be set: self.count = 1.": "Nur Variablen können gesetzt werden: self.count = 1.",
    "Write {x} in a method of class Task.": "Schreiben Sie {x} in eine Methode von class Task.",
    "Write “and” or “or”.": "Schreiben Sie „and“ oder „or“.",
    "Write “not”.": "Schreiben Sie „not“.",
    "Write self.count = self.count + 1.": "Schreiben Sie self.count = self.count + 1.",
    "Blocks are indented by 4 spaces and have no braces.": "Blöcke sind um 4 Leerzeichen eingerückt und haben keine "
    "geschweiften Klammern.",
    "Leave the semicolon out.": "Lassen Sie das Semikolon weg.",
    "There is no if, for, while or try right before this, at the same level.": "Direkt davor steht auf derselben Ebene "
    "kein if, for, while oder try.",
    # names that are known
    "self.{x} is a variable: a value, as in {y}.": "self.{x} ist eine Variable: ein Wert, wie in {y}.",
    "self.{x} is a parameter: a value, as in {y}.": "self.{x} ist ein Parameter: ein Wert, wie in {y}.",
    "self.{x} is a place; a robot goes there by {y}.": "self.{x} ist ein Ort; ein Roboter fährt dorthin mit {y}.",
    "self.{x} is a zone; it can be asked whether {y}.": "self.{x} ist eine Zone; man kann fragen, ob {y}.",
    "self.{x} is given; it can {y}.": "self.{x} ist gegeben; es kann: {y}.",
    "self.{x} is a machine; it can {y}. Only robots pick and drop.": "self.{x} ist eine Maschine; sie kann: {y}. Nur "
    "Roboter nehmen auf und legen ab.",
    "self.{x} is a machine; it can {y}. What can be read of it: {z}.": "self.{x} ist eine Maschine; sie kann: {y}. "
    "Was von ihr gelesen werden kann: {z}.",
    "self.{x} is a machine; it can {y}.": "self.{x} ist eine Maschine; sie kann: {y}.",
    "The site has no device {x}, which run gives to {y}.": "Der Standort hat kein Gerät {x}, das run an {y} gibt.",
    "self.{x} is a function: it is called on a line of its own, {y}.": "self.{x} ist eine Funktion: Sie wird in einer "
    "eigenen Zeile aufgerufen, {y}.",
    "{x} begins by itself. To repeat steps, write while True: or for _ in range(3):.": "{x} beginnt von selbst. Um "
    "Schritte zu wiederholen, schreiben Sie while True: oder for _ in range(3):.",
    "Write {x}: it belongs to this function or loop alone.": "Schreiben Sie {x}: Es gehört nur zu dieser Funktion oder "
    "Schleife.",
    "Did you mean {x}? What it can do: {y}.": "Meinten Sie {x}? Was es kann: {y}.",
    "Did you mean {x}? What can be read here: {y}.": "Meinten Sie {x}? Was hier gelesen werden kann: {y}.",
    "Did you mean {x}? In expressions only these can be called: {y}.": "Meinten Sie {x}? In Ausdrücken können nur "
    "diese aufgerufen werden: {y}.",
    "Did you mean {x}? It takes: {y}.": "Meinten Sie {x}? Es nimmt: {y}.",
    "Did you mean {x}? Catch TaskError, or some of: {y}.": "Meinten Sie {x}? Fangen Sie TaskError, oder einige von: "
    "{y}.",
    "Did you mean {x}?": "Meinten Sie {x}?",
    "It takes: {x}.": "Es nimmt: {x}.",
    "A text stands in quotation marks: {x}. Devices and variables have self. before them: {y}.": "Ein Text steht in "
    "Anführungszeichen: {x}. Vor Geräten und Variablen steht self.: {y}.",
    "{x} needs its values in brackets: {y}. A variable has self. before it: {z}.": "{x} braucht seine Werte in "
    "Klammern: {y}. Vor einer Variablen steht self.: {z}.",
    "{x} is read without brackets, as in if {y} > 60:.": "{x} wird ohne Klammern gelesen, wie in if {y} > 60:.",
    "A reading alone does nothing. Use it, as in if {x} > 60:.": "Ein Messwert allein tut nichts. Verwenden Sie ihn, "
    "wie in if {x} > 60:.",
    "A reading cannot be set; it changes by what the machine does.": "Ein Messwert kann nicht gesetzt werden; er "
    "ändert sich durch das, was die Maschine tut.",
    "This is something that it does. Write it on a line of its own: {x}.": "Das ist etwas, was es tut. Schreiben Sie "
    "es in eine eigene Zeile: {x}.",
    "This gives no value. Write it on a line of its own: {x}.": "Das gibt keinen Wert. Schreiben Sie es in eine eigene "
    "Zeile: {x}.",
    "It gives no value. Write it on a line of its own, without the name before it.": "Es gibt keinen Wert. Schreiben "
    "Sie es in eine eigene Zeile, ohne den Namen davor.",
    "Keep it first, on a line of its own: {x}. Then use self.result.": "Behalten Sie es erst, in einer eigenen Zeile: "
    "{x}. Verwenden Sie dann self.result.",
    "Where it is stands only in move. Elsewhere write {x}.": "Wo es ist, steht nur in move. Schreiben Sie sonst {x}.",
    "Which machine it is shows only in the run. Write {x}.": "Welche Maschine es ist, zeigt sich erst im Lauf. "
    "Schreiben Sie {x}.",
    "Name the device or the place itself: self.oven.": "Nennen Sie das Gerät oder den Ort selbst: self.oven.",
    "Write the device or the place: self.oven.": "Schreiben Sie das Gerät oder den Ort: self.oven.",
    "Write brackets behind it: {x}.": "Schreiben Sie Klammern dahinter: {x}.",
    "Write a text in quotation marks: {x}.": "Schreiben Sie einen Text in Anführungszeichen: {x}.",
    "{x} takes no value.": "{x} nimmt keinen Wert.",
    "{x} takes one value.": "{x} nimmt einen Wert.",
    "{x} takes {y} values or more.": "{x} nimmt {y} Werte oder mehr.",
    "{x} takes {y} values.": "{x} nimmt {y} Werte.",
    "Use round(self.a / self.b).": "Verwenden Sie round(self.a / self.b).",
    "Compare with {x}.": "Vergleichen Sie mit {x}.",
    "Leave it out: every value is there.": "Lassen Sie es weg: Jeder Wert ist da.",
    "Write one of: {x}, or a number with its unit: {y}.": "Schreiben Sie eines von: {x}, oder eine Zahl mit ihrer "
    "Einheit: {y}.",
    "Write one of: {x}.": "Schreiben Sie eines von: {x}.",
    # loops, tries and variables
    "Write these lines behind the loop, without else.": "Schreiben Sie diese Zeilen hinter die Schleife, ohne else.",
    "Write these lines at the end of what try holds.": "Schreiben Sie diese Zeilen ans Ende dessen, was in try steht.",
    "Put the kinds together: except (Failed, Offline):.": "Fassen Sie die Arten zusammen: except (Failed, Offline):.",
    "Count it yourself: {x} before the loop, {y} at its end.": "Zählen Sie selbst: {x} vor der Schleife, {y} an ihrem "
    "Ende.",
    "Say how often: {x}.": "Sagen Sie, wie oft: {x}.",
    "Say how often, with one number: {x}.": "Sagen Sie mit einer Zahl, wie oft: {x}.",
    "Write square brackets: {x}.": "Schreiben Sie eckige Klammern: {x}.",
    "Name each: {x}.": "Nennen Sie jedes einzeln: {x}.",
    "A loop has one name, without self. Write {x}: or {y}:.": "Eine Schleife hat einen Namen, ohne self. Schreiben Sie "
    "{x}: oder {y}:.",
    "Rounds are counted from 1. Write {x}:.": "Runden werden von 1 an gezählt. Schreiben Sie {x}:.",
    "Give the number of the round a name of its own.": "Geben Sie der Nummer der Runde einen eigenen Namen.",
    "Set one variable on each line: self.count = 1.": "Setzen Sie in jeder Zeile eine Variable: self.count = 1.",
    "Leave the type out: {x}.": "Lassen Sie den Typ weg: {x}.",
    # run and the class
    "self.new_task() ends run. Put this before it, or leave it out.": "Mit self.new_task() endet run. Setzen Sie das "
    "davor oder lassen Sie es weg.",
    "Write self.new_task() as its last line.": "Schreiben Sie self.new_task() als seine letzte Zeile.",
    "Write self.new_task() without values.": "Schreiben Sie self.new_task() ohne Werte.",
    "It is given already. Choose another name.": "Es ist schon gegeben. Wählen Sie einen anderen Namen.",
    "Put it in new_task. In run there is only what it gives, and self.new_task() once.": "Setzen Sie es in new_task. "
    "In run steht nur, was gegeben wird, und einmal self.new_task().",
    "Write ctx.when({x}), with a method of the task.": "Schreiben Sie ctx.when({x}), mit einer Methode der Aufgabe.",
    "Give it a name: {x}.": "Geben Sie ihm einen Namen: {x}.",
    "Write self.{x}, or set it in new_task.": "Schreiben Sie self.{x}, oder setzen Sie es in new_task.",
    "Write {x}. Values come by ctx.parameter.": "Schreiben Sie {x}. Werte kommen durch ctx.parameter.",
    "Leave {x} out.": "Lassen Sie {x} weg.",
    "Set it in new_task: {x}.": "Setzen Sie es in new_task: {x}.",
    "Write def new_task(self): and def run(self, ctx): in class Task.": "Schreiben Sie def new_task(self): und "
    "def run(self, ctx): in class Task.",
    "In the class there are only methods. Put it in one, such as new_task.": "In der Klasse stehen nur Methoden. "
    "Setzen Sie es in eine, etwa in new_task.",
    "Write class Task(object):, as the script's first line.": "Schreiben Sie class Task(object): als erste Zeile des "
    "Skripts.",
    "Put it in class Task, with self first: {x}.": "Setzen Sie es in class Task, mit self als Erstem: {x}.",
    "Leave it out: VIPO runs the task by itself.": "Lassen Sie es weg: VIPO führt die Aufgabe von selbst aus.",
    "Put it in class Task, or leave it out.": "Setzen Sie es in class Task oder lassen Sie es weg.",
    "Put its lines at the beginning of new_task.": "Setzen Sie seine Zeilen an den Anfang von new_task.",
    # what Python has and the language does not
    "There are +, -, *, /, abs, round, min and max. Reckon the rest beforehand and write the number.": "Es gibt +, -, "
    "*, /, abs, round, min und max. Rechnen Sie den Rest vorher aus und schreiben Sie die Zahl.",
    "Write one pair of brackets only.": "Schreiben Sie nur ein Paar Klammern.",
    "What failed cannot be read. Write a text of your own.": "Was scheiterte, kann nicht gelesen werden. Schreiben Sie "
    "einen eigenen Text.",
    "Write except without the star.": "Schreiben Sie except ohne den Stern.",
    "Leave “async” out: a script waits by itself until a step is done.": "Lassen Sie „async“ weg: Ein Skript wartet "
    "von selbst, bis ein Schritt fertig ist.",
    "Leave “async with” out and write its lines as they are.": "Lassen Sie „async with“ weg und schreiben Sie seine "
    "Zeilen so, wie sie sind.",
    "Write each step on a line of its own.": "Schreiben Sie jeden Schritt in eine eigene Zeile.",
    "Write for _ in range(3):.": "Schreiben Sie for _ in range(3):.",
    "range stands only in a loop: for _ in range(3):.": "range steht nur in einer Schleife: for _ in range(3):.",
    "Add the values: self.first + self.second.": "Zählen Sie die Werte zusammen: self.first + self.second.",
    "Join the conditions with “or”.": "Verbinden Sie die Bedingungen mit „or“.",
    "Join the conditions with “and”.": "Verbinden Sie die Bedingungen mit „and“.",
    "Write a condition, such as self.count > 0.": "Schreiben Sie eine Bedingung, etwa self.count > 0.",
    "Write the values in square brackets: [1, 2].": "Schreiben Sie die Werte in eckige Klammern: [1, 2].",
    "Write the values in the order that you want.": "Schreiben Sie die Werte in der gewünschten Reihenfolge.",
    "A task leaves nothing to chance. Write the value itself.": "Eine Aufgabe überlässt nichts dem Zufall. Schreiben "
    "Sie den Wert selbst.",
    "The time of day is now().": "Die Uhrzeit ist now().",
    "A script cannot use the computer, only devices that run gives.": "Ein Skript kann den Rechner nicht benutzen, nur "
    "Geräte, die run gibt.",
    "A script waits by itself until a step is done. Leave “asyncio” out.": "Ein Skript wartet von selbst, bis ein "
    "Schritt fertig ist. Lassen Sie „asyncio“ weg.",
    "Write True, with a large first letter.": "Schreiben Sie True, mit großem Anfangsbuchstaben.",
    "Write False, with a large first letter.": "Schreiben Sie False, mit großem Anfangsbuchstaben.",
    "Write a value; there is no empty one.": "Schreiben Sie einen Wert; einen leeren gibt es nicht.",
    "Write self.": "Schreiben Sie self.",
    "Say what of it, such as self.count or self.oven.temperature.": "Sagen Sie, was davon, etwa self.count oder "
    "self.oven.temperature.",
    "ctx gives things only in run: {x}.": "ctx gibt nur in run etwas: {x}.",
    "Leave it out: a block ends where the lines are no longer indented.": "Lassen Sie es weg: Ein Block endet, wo die "
    "Zeilen nicht mehr eingerückt sind.",
    "Leave it out: a block begins where the lines are indented.": "Lassen Sie es weg: Ein Block beginnt, wo die Zeilen "
    "eingerückt sind.",
    # where Python cannot read on, by what stands there
    'Write a number with its unit as quantity(5, "min").': "Schreiben Sie eine Zahl mit ihrer Einheit als "
    'quantity(5, "min").',
    "Write a name of one word and brackets behind it: def mix_paint(self):.": "Schreiben Sie einen Namen aus einem "
    "Wort und Klammern dahinter: def mix_paint(self):.",
    "Write “{x}” in small letters.": "Schreiben Sie „{x}“ in Kleinbuchstaben.",
    "Write elif or else.": "Schreiben Sie elif oder else.",
    "Write if.": "Schreiben Sie if.",
    "Write while.": "Schreiben Sie while.",
    "Write def mix_paint(self):.": "Schreiben Sie def mix_paint(self):.",
    "Write except TaskError:.": "Schreiben Sie except TaskError:.",
    "Set it as self.count = 1.": "Setzen Sie es als self.count = 1.",
    "A note begins with #.": "Eine Notiz beginnt mit #.",
    "Write the number without zeros before it.": "Schreiben Sie die Zahl ohne Nullen davor.",
    "Write a dot: self.wait(60).": "Schreiben Sie einen Punkt: self.wait(60).",
    "Write a dot behind self: self.wait(60).": "Schreiben Sie einen Punkt hinter self: self.wait(60).",
    "Write >= or <=.": "Schreiben Sie >= oder <=.",
    "Write !=.": "Schreiben Sie !=.",
    "Type {x} in place of {y}.": "Tippen Sie {x} statt {y}.",
    "Leave “then” out; a colon ends the line.": "Lassen Sie „then“ weg; ein Doppelpunkt beendet die Zeile.",
    "Write for oven in [self.oven_a, self.oven_b]:.": "Schreiben Sie for oven in [self.oven_a, self.oven_b]:.",
    "Write brackets: {x}.": "Schreiben Sie Klammern: {x}.",
    "Write what is compared on both sides of “and” or “or”.": "Schreiben Sie auf beiden Seiten von „and“ oder „or“, "
    "was verglichen wird.",
    "Something is missing here, or too much. A step is written like self.wait(60).": "Hier fehlt etwas, oder es ist "
    "etwas zu viel. Ein Schritt wird wie self.wait(60) geschrieben.",
    # what was found
    "A second name": "Ein zweiter Name",
    "A second except": "Ein zweites except",
    "An else behind a loop": "Ein else hinter einer Schleife",
    "An else behind try": "Ein else hinter try",
    "A second “{x}”": "Ein zweites „{x}“",
    "A second method {x}": "Eine zweite Methode {x}",
    "A second zone {x}": "Eine zweite Zone {x}",
    "A second {x}": "Ein zweites {x}",
    "A method __init__": "Eine Methode __init__",
    "A run that begins nothing": "Ein run, das nichts beginnt",
    "This new_task": "Dieses new_task",
    "A task without {x}": "Eine Aufgabe ohne {x}",
}
