// @vitest-environment jsdom
/** A comment that is being written stays until it is sent or given up, whatever the screen shows meanwhile. */
import { MantineProvider } from "@mantine/core";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, test, vi } from "vitest";
import type { ReactNode } from "react";
import { keys } from "@/api/queries";
import type { Thread } from "@/api/types";
import { testsPages } from "@/testing/page";
import { CommentForm } from "./CommentForm";
import { TalkContext } from "./talk";
import { ThreadCard } from "./ThreadCard";

let queries: QueryClient;
let program = 0;

function At({ children }: { children: ReactNode }) {
  return (
    <MantineProvider>
      <QueryClientProvider client={queries}>
        <TalkContext value={{ program: "p", role: "author", tell: () => undefined }}>{children}</TalkContext>
      </QueryClientProvider>
    </MantineProvider>
  );
}

function signIn(id: number) {
  queries = new QueryClient({ defaultOptions: { queries: { staleTime: Infinity } } });
  queries.setQueryData(keys.me, { user: { id } });
  queries.setQueryData(keys.peopleToMention("p"), []);
}

interface Sending {
  about?: string;
  onSend?: () => Promise<unknown>;
}

const done = vi.fn();
function Form({ about = "Comment", onSend = () => Promise.resolve() }: Sending) {
  const name = `program/${program}`;
  return (
    <At>
      <CommentForm key={about} draft={name} label={about} send="Send" onSend={onSend} onDone={done} />
    </At>
  );
}

const field = (label = "Comment") => screen.getByLabelText<HTMLTextAreaElement>(label);
const write = (value: string, label?: string) => fireEvent.change(field(label), { target: { value } });

testsPages();
beforeEach(() => {
  done.mockReset();
  program += 1;
  signIn(7);
});

test("what is written is there again once its form is back on the screen, for who wrote it alone", () => {
  render(<Form />).unmount();
  render(<Form />);
  write("Why so slow?");
  cleanup();
  signIn(8);
  render(<Form />);
  expect(field().value).toBe("");
  cleanup();
  signIn(7);
  render(<Form />);
  expect(field().value).toBe("Why so slow?");
  expect(document.activeElement).toBe(field());
});

test("what is written stays in the form when another thing is chosen that it is about", () => {
  const { rerender } = render(<Form about="On 1 Wait" />);
  write("Why so slow?", "On 1 Wait");
  rerender(<Form about="On 2 Move" />);
  expect(field("On 2 Move").value).toBe("Why so slow?");
});

test.each(["Escape", "Cancel"])("what is given up by %s is gone", (how) => {
  const { unmount } = render(<Form />);
  write("Why so slow?");
  if (how === "Escape") fireEvent.keyDown(field(), { key: "Escape" });
  else fireEvent.click(screen.getByText("Cancel"));
  expect(done).toHaveBeenCalledOnce();
  unmount();
  render(<Form />);
  expect(field().value).toBe("");
});

test("what is sent is gone, also when its form has left the screen before; what was written since stays", async () => {
  let answer = (): void => undefined;
  const onSend = () => new Promise<void>((resolve) => (answer = resolve));
  render(<Form onSend={onSend} />);
  write("Why so slow?");
  fireEvent.click(screen.getByText("Send"));
  cleanup();
  act(() => answer());
  await waitFor(() => expect(done).toHaveBeenCalledOnce());
  render(<Form onSend={onSend} />);
  expect(field().value).toBe("");
  write("And this?");
  fireEvent.click(screen.getByText("Send"));
  write("And this? And that?");
  act(() => answer());
  await waitFor(() => expect(done).toHaveBeenCalledTimes(2));
  expect(field().value).toBe("And this? And that?");
});

test("what is being sent is sent once, also from the form about another thing that has its text meanwhile", async () => {
  const answers: (() => void)[] = [];
  const onSend = vi.fn(() => new Promise<void>((resolve) => answers.push(resolve)));
  const { rerender } = render(<Form about="On 1 Wait" onSend={onSend} />);
  write("Why so slow?", "On 1 Wait");
  fireEvent.click(screen.getByText("Send"));
  rerender(<Form about="On 2 Move" onSend={onSend} />);
  fireEvent.submit(field("On 2 Move").form as HTMLFormElement);
  expect(screen.getByRole<HTMLButtonElement>("button", { name: "Send" }).disabled).toBe(true);
  expect(onSend).toHaveBeenCalledOnce();
  for (const answer of answers) act(answer);
  await waitFor(() => expect(field("On 2 Move").value).toBe(""));
  write("And here?", "On 2 Move");
  fireEvent.click(screen.getByText("Send"));
  expect(onSend).toHaveBeenCalledTimes(2);
});

test("what was refused can be sent again, and says why it was", async () => {
  const onSend = vi.fn(() => Promise.reject(new Error("no")));
  render(<Form onSend={onSend} />);
  write("Why so slow?");
  for (const times of [1, 2]) {
    fireEvent.click(screen.getByText("Send"));
    await waitFor(() => expect(screen.getByRole<HTMLButtonElement>("button", { name: "Send" }).disabled).toBe(false));
    expect(onSend).toHaveBeenCalledTimes(times);
  }
  expect([field().value, screen.getByRole("alert").textContent]).toEqual(["Why so slow?", expect.stringMatching(/./)]);
});

const THREAD = {
  ...{ id: "t", unread: 0, resolved_at: null },
  comments: [
    { id: "c", text: "Slow.", mentions: [], author: { id: 7, name: "Ada" }, written_at: "2026-11-21T12:00:00Z" },
  ],
} as unknown as Thread;

test("an answer and a change of one's comment that are being written are open again with their thread", () => {
  const card = (
    <At>
      <ThreadCard thread={THREAD} me={7} about="1 Wait" opened={false} isFirst={false} />
    </At>
  );
  render(card);
  for (const button of ["Answer", "Edit"]) fireEvent.click(screen.getByRole("button", { name: button }));
  const texts = () => screen.getAllByRole<HTMLTextAreaElement>("textbox");
  expect(texts().map(({ value }) => value)).toEqual(["Slow.", ""]);
  for (const [at, value] of ["Slow here.", "Since when?"].entries())
    fireEvent.change(texts()[at] as Element, { target: { value } });
  cleanup();
  render(card);
  expect(texts().map(({ value }) => value)).toEqual(["Slow here.", "Since when?"]);
  expect(texts()).not.toContain(document.activeElement);
  for (const button of screen.getAllByText("Cancel")) fireEvent.click(button);
  expect(screen.queryByRole("textbox")).toBeNull();
});

test("a name is taken by a whole press: a finger that begins on one may scroll", () => {
  queries.setQueryData(keys.peopleToMention("p"), [{ id: 3, username: "ada", name: "Ada" }]);
  render(<Form />);
  field().focus();
  write("@a");
  const name = screen.getByText("Ada");
  expect(fireEvent.pointerDown(name, { pointerType: "touch" }), "the field keeps the keyboard").toBe(false);
  fireEvent.pointerCancel(name, { pointerType: "touch" });
  expect(field().value).toBe("@a");
  fireEvent.click(screen.getByText("Ada"));
  expect(field().value).toMatch(/^@Ada/);
});
