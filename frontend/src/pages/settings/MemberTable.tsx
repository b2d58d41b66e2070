/** The members of a site: who they are, what they may do, and when they were there last. */
import { Menu, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { CalendarClock, Ellipsis, KeyRound, LogOut, Search, UserMinus } from "lucide-react";
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Member, Role } from "@/api/types";
import { Avatar } from "@/design/Avatar";
import { Chip } from "@/design/Chip";
import { IconButton } from "@/design/IconButton";
import { Panel } from "@/design/Panel";
import { useNow } from "@/design/useNow";
import { formatAgo, formatMoment } from "@/i18n/format";
import { tellRefusal } from "@/shell/refusal";
import pages from "../pages.module.css";
import { AccessEnd, AskLeave, AskRemove, AskReset } from "./MemberDialogs";
import { findMembers, isLastAdmin, useChangeMember } from "./people";
import { RoleChip, RoleSelect } from "./RoleSelect";
import styles from "./settings.module.css";

/** Their pages tell it once a minute. */
const HERE_MS = 75_000;
const COLUMNS = ["name", "mail", "role", "seen", "act"];
/** From so many on there is a field to find them by. */
const MANY = 6;

export type Doing = { do: "end" | "remove" | "leave" | "reset"; member: Member };

function isHere(member: Member, now: number): boolean {
  return member.seen_at !== null && now - new Date(member.seen_at).getTime() < HERE_MS;
}

function Seen({ member, now }: { member: Member; now: number }) {
  const { t } = useTranslation();
  const isOver = member.ends_at !== null && new Date(member.ends_at).getTime() <= now;
  if (member.is_closed) return <>{t("people.closed")}</>;
  if (isOver) return <Chip tone="warn">{t("people.ended")}</Chip>;
  return (
    <>
      {isHere(member, now) ? (
        <span className={styles.here}>{t("people.here")}</span>
      ) : (
        <span>{member.seen_at ? formatAgo(member.seen_at, now) : t("people.neverSeen")}</span>
      )}
      {member.ends_at ? `, ${t("people.until", { when: formatMoment(member.ends_at) })}` : null}
    </>
  );
}

interface RowProps {
  member: Member;
  now: number;
  /** Whoever looks is an admin. */
  manages: boolean;
  last: boolean;
  busy: boolean;
  setRole: (role: Role) => void;
  begin: (doing: Doing) => void;
}

function More({ member, manages, begin }: Pick<RowProps, "member" | "manages" | "begin">) {
  const { t } = useTranslation();
  return (
    <Menu width={230} position="bottom-end">
      <Menu.Target>
        <IconButton label={t("people.more", { name: member.name })}>
          <Ellipsis size={17} aria-hidden="true" />
        </IconButton>
      </Menu.Target>
      <Menu.Dropdown>
        {manages ? (
          <Menu.Item leftSection={<CalendarClock size={15} />} onClick={() => begin({ do: "end", member })}>
            {t("people.end.menu")}
          </Menu.Item>
        ) : null}
        {manages && member.second_factor && !member.me ? (
          <Menu.Item leftSection={<KeyRound size={15} />} onClick={() => begin({ do: "reset", member })}>
            {t("factor.reset.menu")}
          </Menu.Item>
        ) : null}
        {member.me ? (
          <Menu.Item leftSection={<LogOut size={15} />} onClick={() => begin({ do: "leave", member })}>
            {t("people.leave.menu")}
          </Menu.Item>
        ) : (
          <Menu.Item
            c="var(--error)"
            leftSection={<UserMinus size={15} />}
            onClick={() => begin({ do: "remove", member })}
          >
            {t("people.remove.menu")}
          </Menu.Item>
        )}
      </Menu.Dropdown>
    </Menu>
  );
}

/** By which ways somebody signs in, where that is not a password alone. */
function WaysOf({ member }: { member: Member }) {
  const { t } = useTranslation();
  const { has_password: hasPassword, sign_in_by: providers, second_factor: factor } = member;
  const ways = [...(hasPassword ? [t("people.ways.password")] : []), ...providers];
  const words = [
    ...(providers.length > 0 ? [t("people.ways.by", { ways: ways.join(", ") })] : []),
    ...(factor ? [t("people.ways.factor")] : []),
  ];
  return words.length > 0 ? <small className={pages.reason}>{words.join(" · ")}</small> : null;
}

function Row({ member, now, manages, last, busy, setRole, begin }: RowProps) {
  const { t } = useTranslation();
  return (
    <tr>
      <td>
        <span className={pages.person}>
          <Avatar name={member.name} initials={member.initials} size={26} live={isHere(member, now)} />
          <span className={pages.strong}>{member.name}</span>
          {member.me ? <span className={pages.none}>{t("people.you")}</span> : null}
        </span>
        {member.came_by ? <small className={pages.reason}>{t("people.cameBy", { name: member.came_by })}</small> : null}
      </td>
      <td className={pages.optional}>
        {member.email}
        <WaysOf member={member} />
      </td>
      <td>
        {manages && !last ? (
          <RoleSelect
            label={t("people.roleOf", { name: member.name })}
            role={member.role}
            busy={busy}
            onChoose={setRole}
          />
        ) : (
          <span title={last && manages ? t("people.lastAdmin") : undefined}>
            <RoleChip role={member.role} />
          </span>
        )}
      </td>
      <td>
        <Seen member={member} now={now} />
      </td>
      <td className={pages.more}>{last ? null : <More {...{ member, manages, begin }} />}</td>
    </tr>
  );
}

function useSetRole(slug: string) {
  const { t } = useTranslation();
  const change = useChangeMember(slug);
  /** Each answer is told, also where another role is set meanwhile. */
  const setRole = (member: Member, role: Role) =>
    change.mutateAsync({ id: member.id, role }).then(
      () => notifications.show({ message: t("people.roleSet", { name: member.name, role: t(`role.${role}`) }) }),
      (error: Error) => tellRefusal(error, t),
    );
  return { setRole, busy: change.isPending ? change.variables.id : null };
}

interface DoingProps {
  slug: string;
  doing: Doing;
  onClose: () => void;
  afterwards: () => HTMLElement | null;
}

function Doing({ slug, doing, onClose, afterwards }: DoingProps) {
  const { member } = doing;
  if (doing.do === "end") return <AccessEnd {...{ slug, member, onClose }} />;
  if (doing.do === "reset") return <AskReset {...{ slug, member, onClose }} />;
  if (doing.do === "remove") return <AskRemove {...{ slug, member, onClose, afterwards }} />;
  return <AskLeave {...{ slug, onClose }} />;
}

export function MemberTable({ slug, members, manages }: { slug: string; members: Member[]; manages: boolean }) {
  const { t } = useTranslation();
  const now = useNow(15_000);
  const [typed, setTyped] = useState("");
  const [doing, setDoing] = useState<Doing | null>(null);
  const heading = useRef<HTMLHeadingElement>(null);
  const { setRole, busy } = useSetRole(slug);
  const found = findMembers(members, typed);
  return (
    <Panel className={styles.section} aria-label={t("people.members")}>
      <div className={styles.head}>
        <h2 ref={heading} tabIndex={-1}>
          {t("people.members")}
        </h2>
        {manages ? <Chip>{members.length}</Chip> : null}
        {members.length >= MANY ? (
          <TextInput
            className={styles.find}
            size="xs"
            leftSection={<Search size={15} aria-hidden="true" />}
            aria-label={t("people.find")}
            placeholder={t("people.find")}
            value={typed}
            onChange={(event) => setTyped(event.currentTarget.value)}
          />
        ) : null}
      </div>
      <div className={pages.scroll}>
        <table className={pages.table}>
          <thead>
            <tr>
              {COLUMNS.map((column) => (
                <th key={column} scope="col" className={column === "mail" ? pages.optional : undefined}>
                  <span className={column === "act" ? "visually-hidden" : undefined}>
                    {t(`people.column.${column}`)}
                  </span>
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {found.map((member) => (
              <Row
                key={member.id}
                member={member}
                now={now}
                manages={manages}
                last={isLastAdmin(member, members) && manages}
                busy={busy === member.id}
                setRole={(role) => void setRole(member, role)}
                begin={setDoing}
              />
            ))}
          </tbody>
        </table>
      </div>
      {found.length === 0 ? <p className={styles.none}>{t("people.nobody")}</p> : null}
      {manages && members.length === 1 ? <p className={styles.none}>{t("people.alone")}</p> : null}
      {doing ? (
        <Doing slug={slug} doing={doing} onClose={() => setDoing(null)} afterwards={() => heading.current} />
      ) : null}
    </Panel>
  );
}
