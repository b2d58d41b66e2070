// @vitest-environment jsdom
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, expect, test } from "vitest";
import { useFocusAfter, useReturnFocus } from "./useReturnFocus";

afterEach(cleanup);

function Dialog() {
  const goOnElsewhere = useReturnFocus(() => document.getElementById("heading"));
  return <input aria-label="in it" onChange={goOnElsewhere} />;
}

function Page({ open, menu }: { open: boolean; menu: boolean }) {
  return (
    <>
      <button id="opener">Open</button>
      {menu ? (
        <div role="menu" aria-labelledby="opener">
          <button role="menuitem">Rename</button>
        </div>
      ) : null}
      {open ? <Dialog /> : null}
    </>
  );
}

test.each([false, true])("the focus goes back to what opened the dialog (by a menu: %s)", (menu) => {
  const { rerender } = render(<Page open={false} menu={menu} />);
  screen.getByRole(menu ? "menuitem" : "button").focus();
  rerender(<Page open menu={menu} />);
  rerender(<Page open menu={false} />);
  screen.getByLabelText("in it").focus();
  rerender(<Page open={false} menu={false} />);
  expect(document.activeElement?.id).toBe("opener");
});

test.each([false, true])("where what opened the dialog has gone, or will (%s), the focus goes elsewhere", (later) => {
  const page = (row: boolean, open: boolean) => (
    <>
      <h2 id="heading" tabIndex={-1}>
        Rows
      </h2>
      {row ? <button>Remove</button> : null}
      {open ? <Dialog /> : null}
    </>
  );
  const { rerender } = render(page(true, false));
  screen.getByText("Remove").focus();
  rerender(page(true, true));
  screen.getByLabelText("in it").focus();
  if (later) fireEvent.change(screen.getByLabelText("in it"), { target: { value: "Yes" } });
  else rerender(page(false, true));
  rerender(page(later, false));
  expect(document.activeElement?.id).toBe("heading");
});

function Card() {
  useFocusAfter(() => document.getElementById("row"));
  return <button>Approve</button>;
}

test.each(["Approve", "Other"])("what goes with the focus hands it on, and takes it from nobody (%s)", (focused) => {
  const page = (open: boolean) => (
    <>
      <button id="row">Row</button>
      <button>Other</button>
      {open ? <Card /> : null}
    </>
  );
  const { rerender } = render(page(true));
  screen.getByText(focused).focus();
  rerender(page(false));
  expect(document.activeElement?.textContent).toBe(focused === "Approve" ? "Row" : "Other");
});
