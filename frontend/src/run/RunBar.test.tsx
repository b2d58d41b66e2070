// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Run } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { run } from "@/testing/runs";
import { RunPill } from "./RunBar";

testsPages();

test("how a run stands is read out when it changes, and its clock is not each second", () => {
  const begun = { ...run(1, { status: "running" }), measured_s: null } as unknown as Run;
  show(<RunPill run={begun} elapsed_s={72} now={Date.now()} />);
  expect(screen.getByText("1:12").closest("[role], [aria-live]")).toBeNull();
  expect(screen.getByRole("status").textContent).toBe("Running");
});
