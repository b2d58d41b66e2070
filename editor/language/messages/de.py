"""The sentences of the checks in German, by the codes and with the arguments of `en.py`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

TEXTS_DE: Final[Mapping[str, str]] = {
    # something is still to be entered
    "missing_quantity": "Geben Sie ein, wie viele {things} zu tragen sind. {robot} trägt {range} auf einmal.",
    "missing_object": "Wählen Sie, was zu tragen ist: {options}.",
    "missing_source": "Wählen Sie, wo der Roboter etwas holt.",
    "missing_target": "Wählen Sie, wo der Roboter etwas abgibt.",
    "missing_destination": "Wählen Sie, wohin der Roboter fährt.",
    "missing_machine": "Wählen Sie die Maschine, die das tut.",
    "missing_method": "Wählen Sie, was {device} tut: {options}.",
    "missing_own_method": "Wählen Sie, was der Roboter tut: {options}.",
    "missing_argument": "Geben Sie {argument} für {method} ein{range}.",
    "missing_condition": "Geben Sie die Bedingung ein, die entscheidet.",
    "missing_seconds": "Geben Sie ein, wie lange gewartet wird, in Sekunden, oder worauf.",
    "missing_function": "Wählen Sie die Funktion, die aufgerufen wird.",
    "missing_function_argument": "Geben Sie {argument} für {function} ein.",
    "missing_times": "Geben Sie ein, wie oft diese Schritte wiederholt werden.",
    "missing_items": "Geben Sie ein, was der Reihe nach durchgegangen wird.",
    "missing_variable": "Geben Sie der Variable einen Namen.",
    "missing_value": "Geben Sie den Wert ein.",
    "missing_question": "Geben Sie die Frage ein.",
    "missing_options": "Geben Sie mindestens zwei Antworten zur Wahl ein.",
    "missing_message": "Geben Sie ein, was mitgeteilt wird.",
    "missing_limit": "Geben Sie ein, wie lange die Schritte darin dauern dürfen, etwa 5 min.",
    "missing_reason": "Geben Sie ein, warum es hier misslingt, etwa „Die Kiste ist nass.“.",
    "empty_program": "Dieses Programm hat noch keine Schritte. Beginnen Sie mit Holen und Bringen.",
    # it speaks of something that does not exist
    "unknown_device": "An diesem Standort gibt es kein Gerät {device}. Wählen Sie ein anderes.",
    "unknown_place": "Auf dieser Karte gibt es keinen Ort {place}. Wählen Sie einen anderen.",
    "unknown_method": "{device} kann {method} nicht. Es kann: {options}.",
    "unknown_property": "{device} meldet {property} nicht. Es meldet: {options}.",
    "unknown_argument": "{method} kennt {argument} nicht. Einzugeben ist: {options}.",
    "unknown_function": "Diese Funktion gibt es nicht mehr. Wählen Sie eine andere.",
    "problem_outside_catch": "{parameter} ist nur im Zweig „sonst“ eines Versuchs bekannt. "
    "Verschieben Sie den Schritt dorthin.",
    "unknown_parameter": "Hier gibt es keinen Wert mit dem Namen {parameter}. Wählen oder schreiben Sie einen anderen.",
    "unknown_role": "Dieses Programm hat keinen Roboter mit dem Namen {role}. Wählen Sie einen anderen.",
    "unknown_kind": "Diese Art von Schritt kennt diese Version von VIPO nicht. Löschen Sie ihn.",
    "odd_shape": "{part} hat nicht die nötige Form und fehlt beim Lesen. Geben Sie es neu ein oder entfernen Sie es.",
    "long_id": "Die Id dieses Schritts hat mehr als {most} Zeichen. Kopieren Sie ihn und löschen Sie diesen.",
    "odd_position": "Der Start hat keine lesbare Position. Ziehen Sie ihn dorthin, wo er hingehört.",
    "newer_format": "Dieses Programm stammt aus einem neueren VIPO. Aktualisieren Sie dieses, um es auszuführen.",
    # it cannot ever work
    "pending_device": "{device} wartet auf Zulassung. Ein Administrator kann es im Register zulassen.",
    "retired_device": "{device} ist nicht mehr in Betrieb. Wählen Sie ein anderes Gerät.",
    "not_a_robot": "{device} ist kein Roboter. Wählen Sie einen Roboter für {role}.",
    "robot_as_place": "{device} ist ein Roboter und kann Objekte weder geben noch nehmen. Wählen Sie eine Maschine.",
    "robot_as_goal": "{device} ist ein Roboter und kann überall sein. Wählen Sie eine Maschine, einen Ort oder Punkt.",
    "may_not_fit": "Auf einem der Wege zu diesem Schritt ist das {device}, und das passt hier nicht.",
    "cannot_do": "{device} kann {method} nicht. Wählen Sie einen Roboter, der das kann.",
    "too_few_robots": "{roles} brauchen gleichzeitig je einen Roboter, und es gibt {count}. Einer kann beides tun.",
    "no_robot_can": "Kein Roboter an diesem Standort kann {methods}.",
    "no_robot_offers": "Kein Roboter an diesem Standort kann {method}. Roboter können hier: {options}.",
    "methods_differ": "{first} und {second} brauchen für {method} verschiedene Werte. Wählen Sie einen Roboter.",
    "no_robot_tells": "Kein Roboter, der {role} sein kann, meldet {property}. Roboter melden hier: {options}.",
    "readings_differ": (
        "{first} und {second} melden {property} verschieden, nach Art oder Einheit. Wählen Sie einen Roboter."
    ),
    "may_not_tell": (
        "{device} kann {role} sein und meldet {property} nicht; dann schlägt das fehl. Wählen Sie einen Roboter."
    ),
    "choice_looks_elsewhere": (
        "Wer {role} ist, darf nur davon abhängen, was der Roboter selbst meldet. Nehmen Sie alles andere heraus."
    ),
    "never_chosen": (
        "Kein Roboter erfüllt je die Bedingung für {role}; das Programm würde ewig warten. Ändern Sie sie."
    ),
    "step_of_its_own": "{method} ist ein eigener Schritt, der den Weg kennt. Zeichnen Sie stattdessen diesen.",
    "not_given": "{device} gibt {object} nicht her. Es gibt: {options}.",
    "not_taken": "{device} nimmt {object} nicht an. Es nimmt: {options}.",
    "wrong_type": "{subject}: Hier wird {wanted} gebraucht, und das ist {given}.",
    "not_comparable": "{left} und {right} lassen sich nicht mit {operator} vergleichen.",
    "wrong_unit": "{subject} ist in {wanted}, und dieser Wert ist in {given}.",
    "temperature_or_difference": (
        "Das kann eine Temperatur oder ein Unterschied von zweien sein; {given} in {wanted} umzurechnen ist dann "
        "zweierlei. Nehmen Sie für beides eine Einheit."
    ),
    "difference_needs_kelvins": (
        "{subject} ist in {wanted}, wo dieser Unterschied als Temperatur gälte. Erklären Sie ihn in K."
    ),
    "units_differ": (
        "{first} zählt {name} in {wanted}, {second} in {given}. "
        "Nennen Sie ein Gerät, geben Sie jeder Art einen Schritt, oder lassen Sie beide in einer Einheit beschreiben."
    ),
    "plain_number": "{subject} ist in {wanted}, und das ist eine bloße Zahl. Geben Sie ihre Einheit an.",
    "unit_not_taken": "{subject} ist eine bloße Zahl, und dieser Wert ist in {given}. Geben Sie an, worin er zählt.",
    "no_such_product": "{left} {operator} {right} misst nichts. Nehmen Sie für eines davon eine bloße Zahl.",
    "divided_by_zero": "Hier wird durch 0 geteilt. Geben Sie eine andere Zahl ein, oder prüfen Sie sie vorher.",
    "may_divide_by_zero": "Auf einem der Wege zu diesem Schritt wird durch 0 geteilt. Prüfen Sie die Zahl vorher.",
    "no_such_item": "Die Liste hat keinen Eintrag mit dieser Nummer. Einträge werden von 1 an gezählt.",
    "may_be_no_such_item": "Die Liste hat hier vielleicht keinen Eintrag mit dieser Nummer. Vergleichen Sie die Nummer "
    "vorher mit len(…).",
    "not_in_a_list": "Eine Liste enthält Zahlen, Texte, ja oder nein, Geräte oder Orte, aber nicht {given}.",
    "mixed_list": "Die Einträge einer Liste sind alle von einer Art, und hier sind {left} und {right}.",
    "list_and_item": "{left} und {right} lassen sich nicht zusammenfügen. Schreiben Sie eckige Klammern um den "
    "Eintrag.",
    "list_too_long": "Die Liste hat {count} Einträge, und höchstens 1000 sind möglich. Machen Sie mehrere Listen "
    "daraus.",
    "may_be_out_of_range": "{subject} muss {range} sein und liegt hier vielleicht außerhalb. Prüfen Sie es vorher.",
    "out_of_range": "{subject} muss {range} sein.",
    "not_an_option": "{subject} ist eines von: {options}.",
    "limit_not_positive": (
        "Ein Zeitlimit muss länger als 0 s sein. Geben Sie ein, wie lange die Schritte darin dauern dürfen."
    ),
    "quantity_not_positive": "Die Menge muss eine ganze Zahl über 0 sein.",
    "quantity_above_capacity": "{robot} trägt {range} auf einmal. Geben Sie weniger ein, oder fahren Sie zweimal.",
    "no_answer_fits": "Keine Zahl ist mindestens {least} und höchstens {most}. Ändern Sie die Grenzen.",
    "carrying_too_much": "{robot} trägt hier schon {carried} und fasst höchstens {capacity}.",
    "may_carry_too_much": "{robot} trägt hier vielleicht schon zu viel. Höchstens {capacity} passen.",
    "drops_nothing": "{robot} trägt hier {carried} {object} und kann nicht {quantity} abgeben.",
    "may_drop_nothing": "{robot} trägt auf einem der Wege zu diesem Schritt weniger als {quantity} {object}.",
    "ends_carrying": "{robot} trägt noch {quantity} {object}, wenn das Programm hier endet. Geben Sie es ab.",
    "releases_carrying": (
        "{robot} trägt hier noch {quantity} {object}. Legen Sie es ab, bevor Sie den Roboter freigeben."
    ),
    "may_release_carrying": (
        "{robot} trägt auf einem der Wege zu diesem Schritt noch {object}. Legen Sie es ab, bevor Sie den Roboter "
        "freigeben."
    ),
    "releases_nothing": (
        "{role} hat auf einem der Wege zu diesem Schritt noch keinen Roboter. Setzen Sie ihn hinter die Schritte des "
        "Roboters, oder löschen Sie ihn."
    ),
    "released_beside": (
        "Zweig {first} gibt {robot} frei, und Zweig {second} braucht ihn. Geben Sie ihn erst danach frei."
    ),
    "place_outside": "Dieser Ort liegt außerhalb der Karte. Ziehen Sie ihn hinein.",
    "place_blocked": "{robot} passt hier nicht hin: Eine Wand oder eine Maschine ist zu nah.",
    "place_unreachable": "{robot} findet keinen Weg zu diesem Ort.",
    "calls_itself": "{function} ruft auf jedem Weg sich selbst auf und käme nie zum Ende.",
    "times_not_whole": "Wie oft, ist eine ganze Zahl ab 0.",
    "return_outside_function": "Nur eine Funktion kann etwas zurückgeben. Beenden Sie stattdessen das Programm.",
    "break_outside_loop": "Um diesen Schritt gibt es keine Schleife, die er verlassen könnte.",
    "same_name": "Die Nummer der Runde braucht einen anderen Namen als der Eintrag, {variable}.",
    "continue_outside_loop": "Um diesen Schritt gibt es keine Schleife, die mit der nächsten Runde weitermachen "
    "könnte. Setzen Sie ihn in eine, oder löschen Sie ihn.",
    "leaves_parallel": "Dieser Schritt würde einen parallelen Zweig verlassen. Lassen Sie den Zweig zu Ende gehen.",
    "leaves_finally": "Dieser Schritt würde ein Finally verlassen, das immer ganz ausgeführt wird.",
    "gives_nothing": "{function} gibt nichts zurück. Nehmen Sie nichts davon, oder geben Sie ihr ein Ergebnis.",
    "returns_unasked": "{function} hat kein Ergebnis. Geben Sie der Funktion eines, oder entfernen Sie diesen Wert.",
    "needed_out_of_range": "Geben Sie ein, wie viele Zweige es beenden: eine ganze Zahl von 1 bis {count}.",
    "too_few_end": "Hier müssen {needed} der Zweige enden, und so viele enden nie; also geht das ewig weiter. Lassen "
    "Sie mehr Zweige enden.",
    "shared_robot": "Die Zweige {first} und {second} fahren beide {robot}. Geben Sie einem einen anderen Roboter.",
    # it works, but perhaps not as it is meant
    "offline_device": "{device} ist offline. Das Programm kann laufen, wenn es wieder da ist.",
    "no_robot_online": "Kein Roboter, der {methods} kann, ist online. Das Programm kann laufen, wenn einer da ist.",
    "may_never_end": "Nichts Gemessenes entscheidet hier; diese Schritte wiederholen sich vielleicht ohne Ende.",
    "never_runs": "Diese Bedingung ist nie wahr; diese Schritte laufen also nie.",
    "always_true": "Diese Bedingung ist immer wahr; der andere Zweig läuft also nie.",
    "catch_never_reached": "Die Zweige „sonst“ davor fangen alle seine Probleme ab; dieser läuft also nie. Wählen Sie "
    "andere für ihn, oder entfernen Sie ihn.",
    "caught_before": "Ein Zweig „sonst“ davor fängt einige seiner Probleme schon ab. Wählen Sie jedes nur in einem "
    "der Zweige.",
    "empty_branch": "Darin steht kein Schritt; es tut also nichts. Zeichnen Sie Schritte hinein, oder löschen Sie es.",
    "over_at_once": "Das ist sofort vorbei und bricht die anderen Zweige ab, denn einige brauchen keine Zeit: "
    "{branches}. Zeichnen Sie Schritte hinein, die Zeit brauchen.",
    "busy_circle": "Das wartet, indem es ständig im Kreis läuft. Warten Sie mit Warten, bis das Gewünschte eintritt.",
    "draft": "Dieser Schritt hängt an nichts und läuft nicht. Verbinden oder löschen Sie ihn.",
    "too_deep": "Dieser Schritt liegt zu tief in anderen und läuft nicht. Machen Sie aus einigen eine Funktion.",
    # the ways through a program
    "never_reached": "Dieser Schritt wird nie erreicht: Was davor kommt, endet immer hier oder geht ewig weiter.",
    "past_limit": (
        "Das Zeitlimit darum ist immer vorbei, bevor dies fertig ist. Geben Sie dem Limit mehr Zeit, "
        "oder kürzen Sie dies."
    ),
    "never_ends": (
        "Diese Schritte wiederholen sich ewig: Die Bedingung ist immer wahr, und kein Schritt "
        "verlässt die Schleife."
    ),
    "no_value_on_some_way": (
        "{function} gibt einen Wert zurück, aber nicht auf jedem Weg. Beenden Sie diesen Weg "
        "mit einem Wert."
    ),
    "unused_result": "Was {function} zurückgibt, wird nicht behalten. Wählen Sie eine Variable dafür.",
    "unused_function": "Nichts ruft {function} auf; diese Schritte laufen also nie.",
    "unused_variable": "{variable} wird hier gesetzt und nie verwendet.",
    "unused_parameter": "Nach {parameter} wird gefragt, und es wird nie verwendet.",
    "unset_variable": "{variable} hat hier noch keinen Wert. Setzen Sie die Variable vorher.",
    "no_robot_yet": (
        "Die Rolle {role} hat hier noch keinen Roboter. Lassen Sie ihn vorher etwas tun, oder wählen Sie einen aus."
    ),
    "perhaps_no_robot_yet": (
        "Die Rolle {role} hat auf einem der Wege zu diesem Schritt noch keinen Roboter. Lassen Sie ihn vorher etwas "
        "tun."
    ),
    "may_be_unset": (
        "{variable} hat auf einem der Wege zu diesem Schritt noch keinen Wert. Setzen Sie die "
        "Variable vorher."
    ),
    "starts_unasked": (
        "Das startet von selbst, und niemand wird dann nach {parameters} gefragt. Geben Sie einen Vorgabewert an, "
        "sonst lässt es sich nicht scharf schalten."
    ),
    "event_shares_robot": (
        "Das läuft neben dem Programm, und beide fahren {robot}. Geben Sie einem einen "
        "anderen Roboter."
    ),
    "branches_set_it": (
        "Zweig {first} und Zweig {second} setzen beide {variable}, und niemand weiß, wer zuletzt. Geben Sie jedem eine "
        "eigene."
    ),
    "loses_update": (
        "Das setzt {variable} nach dem, was vorher galt. Was daneben inzwischen gesetzt wurde, geht verloren; "
        "lesen Sie den Wert neu."
    ),
    "branches_wait": (
        "Die Zweige {first} und {second} warten aufeinander, auf {variable} und {other}. "
        "Setzen Sie eines davon vor dem Warten."
    ),
    # functions of the library
    "version_gone": (
        "Version {version} von {function} ist nicht mehr in der Bibliothek. Die Kopie in "
        "diesem Programm geht weiterhin."
    ),
    "newer_version": "Die Bibliothek hat Version {newest} von {function}; dieses Programm verwendet Version {version}.",
    "signature_changed": (
        "Version {newest} von {function} in der Bibliothek passt nicht ohne Weiteres: Sie nimmt andere Werte, gibt "
        "einen anderen zurück oder braucht andere Geräte. Sie nimmt: {parameters}. Sehen Sie sie in der Bibliothek an, "
        "bevor Sie sie holen."
    ),
    # values: units, zones and ranges
    "unknown_unit": "{unit} ist keine Einheit, die VIPO kennt. Wählen Sie eine andere.",
    "unknown_zone": "Es gibt keine Zone {zone} in diesem Programm. Zeichnen Sie sie, oder wählen Sie eine andere.",
    "never_true_in_range": "{property} von {device} ist immer {range}; deshalb gilt das nie.",
    "always_true_in_range": "{property} von {device} ist immer {range}; deshalb gilt das immer.",
    "contradiction": "Diese Bedingungen schließen einander aus; deshalb gilt das nie.",
    "waits_for_ever": "Das tritt nie ein; das Programm wartet für immer. Ändern Sie es, oder setzen Sie eine Grenze.",
    # machines on the floor, and zones
    "station_unreachable": (
        "{robot} findet keinen Weg zu {device} oder keinen Platz daneben. Die Prüfung der Fläche sagt, warum."
    ),
    "place_in_keep_out": (
        "Dieser Ort liegt in {zone}, wo kein Roboter hineinfährt. Wählen Sie einen anderen, "
        "oder ändern Sie die Zone."
    ),
    "route_too_long": "Dieser Weg hat {count} Punkte, und höchstens {most} sind möglich. Nehmen Sie einige heraus.",
    "missing_zone": "Wählen Sie die Zone, die {robot} abfahren soll.",
    "cover_in_keep_out": (
        "{zone} ist eine Zone, in die kein Roboter fährt. Wählen Sie eine andere, oder ändern Sie ihre Regel."
    ),
    "cover_outside": "{zone} liegt außerhalb der Karte. Zeichnen Sie die Zone auf die Karte.",
    "cover_nothing": (
        "{robot} kann nirgends in {zone} stehen oder findet nicht dorthin. Zeichnen Sie die Zone auf freien Boden."
    ),
    "too_many_lanes": (
        "{zone} ist für so schmale Bahnen zu groß. Machen Sie die Bahnen breiter oder die Zone kleiner."
    ),
    "lane_wider_than_zone": (
        "{zone} ist schmaler als eine Bahn, {robot} fährt also einmal durch die Mitte. Machen Sie die Zone breiter."
    ),
    "route_blocked": (
        "{robot} kann nicht über Punkt {number} dieses Wegs fahren: Er liegt zu nah an einer Wand oder Maschine oder "
        "außerhalb der Karte, oder kein Weg führt dorthin. Verschieben Sie den Punkt."
    ),
    "route_in_keep_out": (
        "Punkt {number} dieses Wegs liegt in {zone}, wo kein Roboter hineinfährt. Verschieben Sie den Punkt, oder "
        "ändern Sie die Zone."
    ),
    "zone_too_small": "{zone} ist kleiner als {robot} und bewirkt deshalb nichts. Vergrößern Sie die Zone.",
    "missing_door": "Wählen Sie die Tür, die bei {zone} für Roboter aufgeht.",
    "door_cannot_open": (
        "{device} kann nicht geöffnet werden, wie es {zone} braucht: mit einer Methode, die so heißt und keine Werte "
        "verlangt. Möglich ist: {options}."
    ),
    "passage_nowhere": (
        "Kein Roboter fährt durch {zone}; die Tür geht deshalb nie auf. Verschieben Sie die Zone in den Durchgang."
    ),
    "door_left_open": (
        "Kein Schritt schließt {device} wieder; das Gerät bleibt offen. Schließen Sie es, oder lassen Sie diesen "
        "Schritt weg: Für Roboter geht es von selbst auf."
    ),
    # a script that was written by hand
    "not_python": "Zeile {line}, Spalte {column}: Das kann nicht gelesen werden. {detail}",
    "not_in_language": "Zeile {line}, Spalte {column}: {found} gehört nicht zur Sprache. {instead}",
    "more_mistakes": "Ab Zeile {line} ist noch mehr zu verbessern: {count}. Beginnen Sie mit den ersten.",
}  # fmt: skip

FIX_TEXTS_DE: Final[Mapping[str, str]] = {
    "set_to": "Auf {value} setzen",
    "take_in": "In {value} nehmen",
    "number_of": "Die Zahl der {value} nehmen",
    "choose": "{value} wählen",
    "remove": "{value} entfernen",
    "join_at_end": "Am Ende des Programms anhängen",
    "delete_step": "Schritt löschen",
    "all_branches": "Auf alle Zweige warten",
    "own_robot": "Zweig {value} bekommt einen eigenen Roboter",
    "use_version": "Version {value} nehmen",
    "take_out": "Unlesbares herausnehmen",
    "make_end": "Stattdessen das Programm beenden",
}


WORDS_DE: Final[Mapping[str, str]] = {
    "and": "und",
    "or": "oder",
    "nothing": "nichts",
    "there is nothing here": "hier gibt es nichts",
    "objects": "Objekte",
    # types of values
    "a number": "eine Zahl",
    "a text": "ein Text",
    "yes or no": "ja oder nein",
    "a list": "eine Liste",
    "a list of numbers": "eine Liste von Zahlen",
    "a list of texts": "eine Liste von Texten",
    "a list of yes or no": "eine Liste von Ja oder Nein",
    "What the loop goes through": "Was die Schleife durchgeht",
    "The number of the item": "Die Nummer des Eintrags",
    "a kind of object": "eine Objektart",
    "a device": "ein Gerät",
    "a place": "ein Ort",
    "a robot": "ein Roboter",
    "a zone": "eine Zone",
    "plain numbers": "bloßen Zahlen",
    "a unit that it does not say": "einer Einheit, die es nicht angibt",
    "a point": "ein Punkt",
    # what a sentence speaks of
    "A condition": "Eine Bedingung",
    "The quantity": "Die Menge",
    "The object": "Das Objekt",
    "The time to wait": "Die Wartezeit",
    "The width of a lane": "Die Breite einer Bahn",
    "The time limit": "Die Zeitgrenze",
    "The place": "Der Ort",
    "How many times": "Wie oft",
    "A value": "Ein Wert",
    "The variable": "Die Variable",
    "The question": "Die Frage",
    "The message": "Die Nachricht",
    "The result": "Das Ergebnis",
    "The first value": "Der erste Wert",
    "One of the values": "Einer der Werte",
}
