// @vitest-environment jsdom
import { expect, test } from "vitest";
import { isTyping, takesLetters } from "./focus";

function element(html: string): Element {
  document.body.innerHTML = html;
  return document.body.firstElementChild ?? document.body;
}

test("letters go on to the drawing from what is no text", () => {
  const kinds = ["checkbox", "radio", "range"].map((type) => element(`<input type="${type}">`));
  expect(kinds.map(takesLetters)).toEqual([false, false, false]);
  expect(takesLetters(element(`<input readonly aria-expanded="false">`))).toBe(false);
});

test("a text, a number and an open list keep their letters", () => {
  expect(takesLetters(element(`<input>`))).toBe(true);
  expect(takesLetters(element(`<textarea></textarea>`))).toBe(true);
  expect(takesLetters(element(`<input readonly aria-expanded="true">`))).toBe(true);
});

test("keys that move and delete stay with any field", () => {
  expect(isTyping(element(`<input type="radio">`))).toBe(true);
  expect(isTyping(element(`<button></button>`))).toBe(false);
});
