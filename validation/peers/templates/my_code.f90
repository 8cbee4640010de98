! A template: put your own method in place of `advance`, compile, and have it graded.
!
!     gfortran -O2 -o my_code my_code.f90
!     shearbed grade --protocol text --command ./my_code
!
! A request is one line of numbers: id, du_i/dx_j row by row, r_e, the time in s, the number of steps or 0, the tolerance or 0,
! the number of rods, and p1 p2 p3 of each. The answer is the id and p1 p2 p3 of each rod at that time, or "ID error REASON".
! See docs/src/user/grading.md.
program my_code
  use, intrinsic :: iso_fortran_env, only: real64, int64, output_unit
  implicit none
  integer, parameter :: most_rods = 4096
  integer(int64) :: id, steps
  integer :: rods, i, j, n, ended
  real(real64) :: l(3, 3), r, time, tolerance, p(3, most_rods)

  do
    ! A list-directed read takes as many numbers as it is told, whatever the line's length.
    read (*, *, iostat=ended) id, ((l(i, j), j=1, 3), i=1, 3), r, time, steps, tolerance, rods, (p(:, n), n=1, rods)
    if (ended /= 0) exit
    if (steps == 0) then
      write (*, '(i0, a)') id, ' error it takes steps, no tolerance'
    else
      do n = 1, rods
        call advance(l, r, time, steps, p(:, n))
      end do
      ! List-directed output would break the line.
      write (*, '(i0, *(1x, es25.16e3))') id, p(:, 1:rods)
    end if
    flush (output_unit)
  end do

contains

  pure function rate(a, p) result(out)
    real(real64), intent(in) :: a(3, 3), p(3)
    real(real64) :: out(3), ap(3)
    ap = matmul(a, p)
    out = ap - p*dot_product(p, ap)
  end function

  ! YOUR METHOD: p after `steps` equal steps to `time`. Here: RK4 of p' = Ap - p (p.Ap), A = W + Lambda D.
  subroutine advance(l, r, time, steps, p)
    real(real64), intent(in) :: l(3, 3), r, time
    integer(int64), intent(in) :: steps
    real(real64), intent(inout) :: p(3)
    real(real64) :: a(3, 3), h, k1(3), k2(3), k3(3), k4(3)
    integer(int64) :: k
    a = (r*r*l - transpose(l))/(r*r + 1)
    h = time/real(steps, real64)
    do k = 1, steps
      k1 = rate(a, p)
      k2 = rate(a, p + h/2*k1)
      k3 = rate(a, p + h/2*k2)
      k4 = rate(a, p + h*k3)
      p = p + h/6*(k1 + 2*k2 + 2*k3 + k4)
    end do
  end subroutine
end program
