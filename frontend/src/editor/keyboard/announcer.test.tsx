// @vitest-environment jsdom
/** Whoever listens hears a sentence again when it is said again. */
import { act, cleanup, render } from "@testing-library/react";
import { afterEach, expect, test } from "vitest";
import { Announcer } from "./Announcer";
import { announce } from "./announcer";

afterEach(cleanup);

test("an equal sentence is written into the other live region, so that it is spoken again", () => {
  const { container } = render(<Announcer />);
  const heard = () => [...container.querySelectorAll("[aria-live=polite]")].map((each) => each.textContent);
  act(() => announce("No more in this direction."));
  const first = heard();
  act(() => announce("No more in this direction."));
  expect([...first].sort()).toEqual(["", "No more in this direction."]);
  expect(heard()).toEqual([...first].reverse());
});
