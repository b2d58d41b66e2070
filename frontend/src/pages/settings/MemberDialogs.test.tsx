// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, render, screen } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import type { Member } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { AccessEnd } from "./MemberDialogs";

beforeEach(async () => {
  vi.stubGlobal("matchMedia", () => ({ matches: false, addEventListener() {}, removeEventListener() {} }));
  await startI18n();
  await loadScreenTexts();
});
afterEach(cleanup);

test.each([
  ["New York", 300, "2026-12-02T04:59:59Z"],
  ["Tokyo", -540, "2026-12-01T14:59:59Z"],
])("the last day of an access is the one that was set, in %s", (_, minutes, ends_at) => {
  vi.spyOn(Date.prototype, "getTimezoneOffset").mockReturnValue(minutes);
  const member = { id: 1, name: "Bo", ends_at } as Member;
  render(
    <QueryClientProvider client={makeQueryClient()}>
      <MantineProvider env="test">
        <MemoryRouter>
          <AccessEnd slug="hall" member={member} onClose={() => undefined} />
        </MemoryRouter>
      </MantineProvider>
    </QueryClientProvider>,
  );
  expect(screen.getByLabelText<HTMLInputElement>("Last day").value).toBe("2026-12-01");
});
