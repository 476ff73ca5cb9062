"""Reports about certificates in HTML."""

from __future__ import annotations

import base64
import io
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph


class Judged:
    """What the compiled half says about a device that does not exist."""

    def __init__(self, verdicts, violations=(), adapter="<GPU & more>"):
        self.given = np.asarray(verdicts, np.uint8)
        undecided = np.isin(self.given, [1, 2]).sum() > 0.01 * self.given.size
        self.outcome = "violated" if violations else "undecided" if undecided else "proved"
        self.is_legal = self.outcome == "proved"
        self.adapter = adapter
        self.given_violations = list(violations)

    def counts(self):
        names = ["decided", "silhouette", "tie", "violation"]
        return [(name, int((self.given == index).sum())) for index, name in enumerate(names)]

    def verdicts(self):
        return self.given

    def violations(self):
        return self.given_violations

    def __str__(self):
        return "all numbers"


class Checked(HTMLParser):
    """Whether all tags are closed, and what a page says."""

    def __init__(self):
        super().__init__()
        self.open, self.text = [], ""

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "br", "img"):
            self.open.append(tag)
        for key, value in attributes:
            assert key not in ("href", "src") or value.startswith("data:"), "a page that needs other files"

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def text_of(html):
    checked = Checked()
    checked.feed(html)
    assert checked.open == []
    return checked.text


def mask_of(html):
    """The picture of the verdicts, decoded by a reader that is not ours where there is one."""
    data = base64.b64decode(re.search(r"data:image/png;base64,([^\"]+)", html)[1])
    image = pytest.importorskip("PIL.Image", reason="Pillow, which reads PNG files, is missing")
    return np.asarray(image.open(io.BytesIO(data)).convert("RGB"))


def test_a_report_says_what_is_wrong():
    verdicts = np.zeros((4, 6))
    verdicts[1, 2], verdicts[3, 5] = 3, 1
    html = ph.Certificate(Judged(verdicts, ["pixel (2, 1): <b>sphere</b> 7 is hidden"]))._repr_html_()
    text = text_of(html)
    assert "Not legal" in text and "<GPU & more>" in text and "<b>sphere</b> 7 is hidden" in text
    assert re.search(r"decided\s*22", text) and re.search(r"violation\s*1\s*4.1667", text)
    assert "<b>sphere" not in html and "all numbers" in text


def test_the_picture_has_the_colors_of_the_verdicts():
    verdicts = np.arange(24).reshape(4, 6) % 4
    mask = mask_of(ph.Certificate(Judged(verdicts))._repr_html_())
    colors = np.array([[0xE4, 0xEB, 0xEF], [0x00, 0x72, 0xB2], [0x56, 0xB4, 0xE9], [0xD5, 0x5E, 0x00]])
    assert np.array_equal(mask, colors[verdicts])


def test_a_single_pixel_is_seen_in_a_large_picture():
    verdicts = np.zeros((3000, 2500))
    verdicts[2999, 1234] = 3
    mask = mask_of(ph.Certificate(Judged(verdicts, ["one"]))._repr_html_())
    assert mask.shape == (1000, 834, 3)
    assert np.argwhere((mask == [0xD5, 0x5E, 0x00]).all(axis=2)).tolist() == [[999, 1234 // 3]]


def test_nothing_was_judged():
    text = text_of(ph.Certificate(Judged(np.zeros((0, 6)), ["upload: sphere 3 has another center"]))._repr_html_())
    assert "Not legal" in text and "sphere 3" in text


def test_many_violations_are_not_all_listed():
    violations = [f"number {index}" for index in range(70)]
    text = text_of(ph.Certificate(Judged(np.full((10, 7), 3), violations))._repr_html_())
    assert "number 49" in text and "number 50" not in text and "20 more are not listed" in text


def test_a_page_is_written(tmp_path):
    certificate = ph.Certificate(Judged(np.zeros((4, 6))))
    certificate.save(tmp_path / "a.html")
    page = (tmp_path / "a.html").read_text("utf-8")
    assert page.startswith("<!DOCTYPE html>") and certificate._repr_html_() in page
    assert "Legal" in text_of(page)
    with pytest.raises(ph.InputError, match="written as .html"):
        certificate.save(tmp_path / "a.png")
    with pytest.raises(ph.FileError, match="cannot be written"):
        certificate.save(tmp_path / "none" / "a.html")


def test_a_device_that_is_judged():
    try:
        certificate = ph.Spheres(cloud(50), 0.2).verify((64, 48))
    except ph.DeviceError as error:
        pytest.skip(f"no device: {error}")
    text = text_of(certificate._repr_html_())
    assert certificate.adapter in text and "64\u2009×\u200948 pixels" in text
    assert str(certificate).splitlines()[0] in text
