"""A file that is sent has a name with which neither a header nor a file system can be led astray."""

from __future__ import annotations

from urllib.parse import unquote

import pytest
from django.http import HttpResponse

from registry.requests import as_file


def name_in(disposition: str) -> str:
    if "filename*=" in disposition:
        return unquote(disposition.partition("filename*=utf-8''")[2])
    return disposition.partition('filename="')[2][:-1]


def test_a_plain_name_stays_as_it_is() -> None:
    assert as_file("hall-audit.csv") == {"Content-Disposition": 'attachment; filename="hall-audit.csv"'}
    assert as_file("Prüfung 1.csv") == {"Content-Disposition": "attachment; filename*=utf-8''Pr%C3%BCfung%201.csv"}


@pytest.mark.parametrize(
    ("name", "fit"),
    [
        ('a"; filename="evil.exe', "a__ filename=_evil.exe"),
        ("a.csv\r\nSet-Cookie: b=c", "a.csv__Set-Cookie_ b=c"),
        ("../../etc/passwd", "_.._etc_passwd"),
        ("C:\\evil.bat", "C__evil.bat"),
        ("invoice\u202efdp.exe", "invoice_fdp.exe"),
        ("a\u2028b\x00c\ud800.csv", "a_b_c_.csv"),
        ("%2e%2e%2fa.csv", "_2e_2e_2fa.csv"),
        (" . ", "file"),
        ("", "file"),
        ("ü" * 1000 + ".csv", "ü" * 146 + ".csv"),
    ],
)
def test_a_hostile_name_becomes_one_that_is_harmless(name: str, fit: str) -> None:
    answer = HttpResponse("", headers=as_file(name))
    assert name_in(answer["Content-Disposition"]) == fit
    assert answer["Content-Disposition"].startswith("attachment; ")
