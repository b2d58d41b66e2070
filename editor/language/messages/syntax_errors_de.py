"""What to write instead of the most frequent mistakes, in German; `{…}` are the pieces that come from the script."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

MISTAKES_DE: Final[Mapping[str, str]] = {
    "Leave it out: a script uses only what self and ctx give.": "Lassen Sie es weg: Ein Skript verwendet nur, was self "
    "und ctx geben.",
    "Write functions beside new_task, in class Task: def mix_paint(self, minutes):.": "Schreiben Sie Funktionen neben "
    "new_task, in class Task: def mix_paint(self, minutes):.",
    "A script has one class, Task. Write a function instead: def mix_paint(self):.": "Ein Skript hat eine Klasse, "
    "Task. Schreiben Sie stattdessen eine Funktion: def mix_paint(self):.",
    "Leave “with” out and write its lines as they are.": "Lassen Sie „with“ weg und schreiben Sie seine Zeilen so, "
    "wie sie sind.",
    "Write if, and inside it self.notify(…) or self.end().": "Schreiben Sie if und darin self.notify(…) oder "
    "self.end().",
    "Leave it out: nothing needs to be deleted.": "Lassen Sie es weg: Nichts muss gelöscht werden.",
    "Leave it out: self.count is seen everywhere.": "Lassen Sie es weg: self.count ist überall bekannt.",
    "Put what follows into an if instead of leaving it out by continue.": "Setzen Sie, was folgt, in ein if, statt es "
    "mit continue auszulassen.",
    "Write if and else instead.": "Schreiben Sie stattdessen if und else.",
    "Write a function beside new_task, in class Task: def mix_paint(self, minutes):.": "Schreiben Sie eine Funktion "
    "neben new_task, in class Task: def mix_paint(self, minutes):.",
    "Write the values one by one, or for oven in [self.oven_a, self.oven_b]:.": "Schreiben Sie die Werte einzeln, oder "
    "for oven in [self.oven_a, self.oven_b]:.",
    "Write if and else on lines of their own.": "Schreiben Sie if und else in eigene Zeilen.",
    "Set the variable on a line of its own: self.count = 1.": "Setzen Sie die Variable in einer eigenen Zeile: "
    "self.count = 1.",
    "Name a value itself; the language has no places in lists.": "Nennen Sie den Wert selbst; die Sprache hat keine "
    "Plätze in Listen.",
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
    "End the program by self.end().": "Beenden Sie das Programm mit self.end().",
    "Write self. before it: {x}": "Schreiben Sie self. davor: {x}",
    "Write the steps themselves.": "Schreiben Sie die Schritte selbst.",
    "Write the value itself.": "Schreiben Sie den Wert selbst.",
    "A script reads no files. Use readings of devices, parameters and questions.": "Ein Skript liest keine Dateien. "
    "Verwenden Sie Messwerte von Geräten, Parameter und Fragen.",
    "Use count(condition, …), or write the number.": "Verwenden Sie count(Bedingung, …) oder schreiben Sie die Zahl.",
    'Write a text with the value in it: f"{self.count} boxes".': "Schreiben Sie einen Text mit dem Wert darin: "
    'f"{{self.count}} boxes".',
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
}
