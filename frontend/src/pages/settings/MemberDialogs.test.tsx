// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import type { Member } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { AccessEnd } from "./MemberDialogs";

testsPages();

test.each([
  ["New York", 300, "2026-12-02T04:59:59Z"],
  ["Tokyo", -540, "2026-12-01T14:59:59Z"],
])("the last day of an access is the one that was set, in %s", (_, minutes, ends_at) => {
  vi.spyOn(Date.prototype, "getTimezoneOffset").mockReturnValue(minutes);
  const member = { id: 1, name: "Bo", ends_at } as Member;
  show(<AccessEnd slug="hall" member={member} onClose={() => undefined} />);
  expect(screen.getByLabelText<HTMLInputElement>("Last day").value).toBe("2026-12-01");
});
