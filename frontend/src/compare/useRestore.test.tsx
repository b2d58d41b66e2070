// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { useState } from "react";
import { expect, test } from "vitest";
import { show, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { useRestore } from "./useRestore";

testsPages();

function Sides() {
  const [version, setVersion] = useState(1);
  const { asked, ask, confirm } = useRestore("p", version, true, () => undefined);
  return (
    <>
      <button onClick={() => ask({ what: "all" })}>Ask</button>
      <button onClick={() => setVersion(2)}>Choose 2</button>
      {asked ? <button onClick={confirm}>{`Restore ${asked.version}`}</button> : null}
    </>
  );
}

test("what was asked of a version is restored out of it, though another one is chosen before the answer comes", async () => {
  const { nth } = slowServer();
  show(<Sides />);
  fireEvent.click(screen.getByText("Ask"));
  const looked = await nth(1);
  fireEvent.click(screen.getByText("Choose 2"));
  await looked.answer(200, { needs: [], changes: [], skipped: [] });
  fireEvent.click(await screen.findByText("Restore 1"));
  const restored = await nth(2);
  expect([looked.asked, restored.asked]).toEqual([
    "POST /api/programs/p/versions/1/restore/look",
    "POST /api/programs/p/versions/1/restore",
  ]);
});
